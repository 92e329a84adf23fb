#include "backend/cuda/compiler.h"

#include "backend/cuda/card_poses.h"
#include "backend/cuda/driver.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <umov/core/files.h>
#include <umov/core/text.h>

namespace umov::backend {

namespace {

using Code = int;
using Program = void *;

} // namespace

struct CardCompiler::Functions {
  Code (*version)(int *major, int *minor) = nullptr;
  Code (*capability_count)(int *count) = nullptr;
  Code (*capabilities)(int *values) = nullptr;
  Code (*create)(Program *program, const char *text, const char *name, int count,
                 const char *const *headers, const char *const *names) = nullptr;
  Code (*destroy)(Program *program) = nullptr;
  Code (*compile)(Program program, int count, const char *const *options) = nullptr;
  Code (*log_size)(Program program, std::size_t *size) = nullptr;
  Code (*log)(Program program, char *text) = nullptr;
  Code (*code_size)(Program program, std::size_t *size) = nullptr;
  Code (*code)(Program program, char *bytes) = nullptr;
  Code (*assembly_size)(Program program, std::size_t *size) = nullptr;
  Code (*assembly)(Program program, char *bytes) = nullptr;

  std::string bind_all(const SharedLibrary &library) {
    std::string lacking;
    const auto bind = [&](const char *name, auto &function) {
      library.bind(name, function, lacking);
    };
    bind("nvrtcVersion", version);
    bind("nvrtcGetNumSupportedArchs", capability_count);
    bind("nvrtcGetSupportedArchs", capabilities);
    bind("nvrtcCreateProgram", create);
    bind("nvrtcDestroyProgram", destroy);
    bind("nvrtcCompileProgram", compile);
    bind("nvrtcGetProgramLogSize", log_size);
    bind("nvrtcGetProgramLog", log);
    bind("nvrtcGetCUBINSize", code_size);
    bind("nvrtcGetCUBIN", code);
    bind("nvrtcGetPTXSize", assembly_size);
    bind("nvrtcGetPTX", assembly);
    return lacking;
  }

  /// What one of the pairs above holds.
  std::string text_of(Program program, Code (*size_of)(Program, std::size_t *),
                      Code (*put)(Program, char *)) const {
    std::size_t size = 0;
    if (size_of(program, &size) != 0 || size == 0)
      return {};
    std::string out(size, '\0');
    return put(program, out.data()) == 0 ? out : std::string();
  }
};

namespace {

constexpr const char *install =
    "Install it: pip install nvidia-cuda-nvrtc (CUDA 13; cards before Turing and drivers of CUDA "
    "12: nvidia-cuda-nvrtc-cu12), and name its folder in UMOV_CUDA_PATH if it is not found";

} // namespace

Result<std::vector<CardCompiler>> CardCompiler::load(std::span<const std::filesystem::path> folders,
                                                     int driver_version) {
  static const std::array<std::string, 3> names{"libnvrtc.so.13", "libnvrtc.so.12",
                                                "libnvrtc.so.11.2"};
  std::string said;
  std::vector<CardCompiler> out;
  std::optional<Error> unfit; // the first that is there and of no use
  for (const SharedLibrary &library : SharedLibrary::all("libnvrtc.so", names, folders, said)) {
    auto one = CardCompiler::of(library);
    if (one)
      out.push_back(std::move(*one));
    else if (!unfit)
      unfit = one.error();
  }
  if (out.empty())
    return unfit ? tl::unexpected(*unfit)
                 : Result<std::vector<CardCompiler>>(fail(
                       ErrorCode::Device, "no compiler for the card: libnvrtc.so was not found (" +
                                              said + "). " + install));
  std::stable_sort(out.begin(), out.end(), [&](const CardCompiler &a, const CardCompiler &b) {
    const bool is_a_newer = a.is_newer_than(driver_version),
               is_b_newer = b.is_newer_than(driver_version);
    if (is_a_newer != is_b_newer)
      return is_b_newer;
    return is_a_newer ? a.version_ < b.version_ : a.version_ > b.version_;
  });
  return out;
}

Result<CardCompiler> CardCompiler::of(const SharedLibrary &library) {
  auto functions = std::make_shared<Functions>();
  const std::string lacking = functions->bind_all(library);
  if (!lacking.empty())
    return fail(ErrorCode::Device,
                library.name() + " is too old: it lacks " + lacking + ". " + install);
  CardCompiler out;
  int major = 0, minor = 0, count = 0;
  functions->version(&major, &minor);
  out.version_ = 1000 * major + 10 * minor;
  out.file_ = library.name();
  functions->capability_count(&count);
  out.capabilities_.resize(static_cast<std::size_t>(std::max(count, 0)));
  if (out.capabilities_.empty() || functions->capabilities(out.capabilities_.data()) != 0)
    return fail(ErrorCode::Device, library.name() + " knows no card. " + install);
  std::sort(out.capabilities_.begin(), out.capabilities_.end());
  out.functions_ = std::move(functions);
  return out;
}

std::string CardCompiler::version() const { return cuda_version_text(version_); }

/// The sizes of what is handed over let the program check that both compilers lay it out alike.
std::vector<std::string> CardCompiler::options_for(int capability, bool is_assembly) const {
  const auto size = [](const char *name, std::size_t bytes) {
    return std::string("-DUMOV_CARD_") + name + "_BYTES=" + std::to_string(bytes);
  };
  return {"--std=c++20",
          "--device-as-default-execution-space",
          std::string("--gpu-architecture=") + (is_assembly ? "compute_" : "sm_") +
              std::to_string(capability),
          "--ptxas-options=-v",
          size("SCENE", sizeof(CardScene)),
          size("BATCH", sizeof(CardBatch)),
          size("POSE", sizeof(PoseData<float>)),
          size("LOBE", sizeof(kernel::LobeAtPose<float>)),
          size("COLOUR", sizeof(SlotColour<float>))};
}

Result<CardImage> CardCompiler::compile(int capability, bool is_assembly) const {
  const std::vector<CardText> &texts = card_texts();
  std::vector<std::string> owned;
  owned.reserve(texts.size());
  for (const CardText &text : texts)
    owned.emplace_back(text.text);
  std::vector<const char *> headers, names, options;
  for (std::size_t k = 1; k < texts.size(); ++k) {
    headers.push_back(owned[k].c_str());
    names.push_back(texts[k].name);
  }
  const std::vector<std::string> asked = options_for(capability, is_assembly);
  for (const std::string &option : asked)
    options.push_back(option.c_str());
  Program program = nullptr;
  if (functions_->create(&program, owned[0].c_str(), texts[0].name,
                         static_cast<int>(headers.size()), headers.data(), names.data()) != 0)
    return fail(ErrorCode::Device, file_ + " takes no program");
  const Code code = functions_->compile(program, static_cast<int>(options.size()), options.data());
  CardImage out;
  out.log = functions_->text_of(program, functions_->log_size, functions_->log);
  if (code == 0) {
    out.assembly = functions_->text_of(program, functions_->assembly_size, functions_->assembly);
    out.bytes = is_assembly ? out.assembly
                            : functions_->text_of(program, functions_->code_size, functions_->code);
  }
  functions_->destroy(&program);
  if (out.bytes.empty())
    return fail(ErrorCode::Device, file_ + " (" + version() +
                                       ") does not compile the kernels for " + asked[2] + ": " +
                                       out.log);
  return out;
}

namespace {

/// Kept with its hash in front: half a file is none.
std::optional<std::string> read_kept(const std::filesystem::path &file) {
  auto kept = read_file(file);
  constexpr std::size_t digits = 64;
  if (!kept || kept->size() <= digits)
    return {};
  std::string bytes = kept->substr(digits);
  if (sha256_hex(bytes) != kept->substr(0, digits))
    return {};
  return bytes;
}

} // namespace

Result<CardImage> CardCompiler::image_for(int capability,
                                          const std::filesystem::path &cache) const {
  if (!knows(capability))
    return fail(ErrorCode::Device, "a card of compute capability " +
                                       std::to_string(capability / 10) + "." +
                                       std::to_string(capability % 10) + " is too old for " +
                                       file_ + " (" + version() + "). " + install);
  // A card that it does not know: assembly of the newest one before it, which the driver compiles.
  const int target =
      *std::prev(std::upper_bound(capabilities_.begin(), capabilities_.end(), capability));
  const bool is_known = !makes_assembly_for(capability);
  if (cache.empty())
    return compile(target, !is_known);
  std::string all = version();
  for (const std::string &option : options_for(target, !is_known))
    all += '\n' + option;
  for (const CardText &text : card_texts())
    all += '\n' + std::string(text.name) + '\n' + std::string(text.text);
  const std::filesystem::path file =
      cache / (sha256_hex(all).substr(0, 16) + (is_known ? ".cubin" : ".ptx"));
  if (auto kept = read_kept(file))
    return CardImage{std::move(*kept), "", ""};
  UMOV_ASSIGN(made, compile(target, !is_known));
  std::error_code code; // what cannot be kept is made again
  std::filesystem::create_directories(cache, code);
  (void)write_file_atomically(file, sha256_hex(made.bytes) + made.bytes);
  return std::move(made);
}

} // namespace umov::backend
