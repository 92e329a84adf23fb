#include <umov/io/signature_file.h>

#include <cstring>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>

namespace umov {
namespace {

constexpr char magic[8] = {'u', 'm', 'o', 'v', 's', 'i', 'g', '1'};
constexpr std::uint64_t byte_order = 0x0102030405060708ull;
constexpr std::uint32_t most_cells = 200, most_bands = 64, most_columns = 4096;

/// Everything of fixed size, in front.
struct Header {
  char magic[8];
  std::uint64_t byte_order;
  std::uint64_t checksum;     ///< of header (this and the next being 0), text and light
  std::uint64_t sum_checksum; ///< of the abundances
  std::uint64_t text_bytes;   ///< a multiple of 8
  std::uint32_t cells, bands, columns, reserved;
  double ln_least, ln_step, error;
};
static_assert(sizeof(Header) == 80);

std::uint64_t padded(std::uint64_t bytes) { return (bytes + 7) / 8 * 8; }

/// Fowler, Noll & Vo's hash over words of eight bytes: tells damage, keeps no secrets.
std::uint64_t hash_of(std::string_view words, std::uint64_t value = 0xCBF29CE484222325ull) {
  for (; words.size() >= 8; words.remove_prefix(8)) {
    std::uint64_t word = 0;
    std::memcpy(&word, words.data(), 8);
    value = (value ^ word) * 0x100000001B3ull;
    value ^= value >> 29; // what is high would never reach down
  }
  return value;
}

/// Where the parts lie.
struct Places {
  std::uint64_t light = 0, sums = 0, end = 0;
};

Places places_of(const Header &header) {
  const std::uint64_t pairs = signature_pairs(header.cells);
  Places out;
  out.light = sizeof(Header) + header.text_bytes;
  out.sums = out.light + padded(pairs * header.bands * 4);
  out.end = out.sums + padded(pairs * header.columns * 4);
  return out;
}

std::uint64_t checksum_of(Header header, std::string_view text_and_light) {
  header.checksum = header.sum_checksum = 0;
  return hash_of(text_and_light, hash_of({reinterpret_cast<const char *>(&header), sizeof header}));
}

bool is_plausible(const Header &h) {
  return h.cells >= 2 && h.cells <= most_cells && h.bands >= 1 && h.bands <= most_bands &&
         h.columns <= most_columns && h.text_bytes % 8 == 0 && h.text_bytes < (1u << 24) &&
         h.reserved == 0 && h.ln_least > -signature_ln_widest && h.ln_step > 0 &&
         h.ln_least + 65'535 * h.ln_step < signature_ln_widest && h.error >= 0 &&
         h.error <= signature_error_most;
}

/// The text; nothing if it is not what it should be.
bool read_text(std::string_view json, const Header &header, SignatureText &out) {
  const auto root = nlohmann::json::parse(json.begin(), json.end(), nullptr, false);
  if (!root.is_object())
    return false;
  const auto list = [&](const char *key, std::size_t count, std::vector<std::string> &to) {
    const auto at = root.find(key);
    if (at == root.end() || !at->is_array() || at->size() != count)
      return false;
    for (const auto &one : *at) {
      if (!one.is_string())
        return false;
      to.push_back(one.get<std::string>());
    }
    return true;
  };
  const auto word = [&](const char *key, std::string &to) {
    const auto at = root.find(key);
    if (at == root.end() || !at->is_string())
      return false;
    to = at->get<std::string>();
    return !to.empty();
  };
  const auto radius = root.find("sun_radius_rad");
  if (radius == root.end() || !radius->is_number())
    return false;
  out.sun_radius_rad = radius->get<double>();
  if (root.contains("device") && !word("device", out.device))
    return false;
  return out.sun_radius_rad >= 0 && out.sun_radius_rad < 1 && word("name", out.name) &&
         word("job", out.job) && word("shape", out.shape) &&
         list("bands", header.bands, out.bands) && list("columns", header.columns, out.columns);
}

std::string json_of(const SignatureText &text) {
  nlohmann::ordered_json out;
  out["name"] = text.name;
  out["job"] = text.job;
  out["shape"] = text.shape;
  if (!text.device.empty())
    out["device"] = text.device;
  out["bands"] = text.bands;
  out["columns"] = text.columns;
  out["sun_radius_rad"] = text.sun_radius_rad;
  std::string json = out.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  json.resize(padded(json.size()), ' ');
  return json;
}

} // namespace

Result<SignatureView> parse_signature(std::string_view bytes, const std::string &file,
                                      bool checks_all) {
  const auto refuse = [&](const std::string &what) {
    return fail(ErrorCode::BadInput, what + ". Remove it and have it made anew: umov library build",
                {file});
  };
  Header header{};
  if (bytes.size() < sizeof header || std::memcmp(bytes.data(), magic, sizeof magic) != 0)
    return refuse("is not a signature of this version");
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.byte_order != byte_order)
    return refuse("was made on a machine with another byte order");
  if (!is_plausible(header))
    return refuse("is damaged: its header makes no sense");
  const Places at = places_of(header);
  if (at.end != bytes.size())
    return refuse(
        fmt::format("is damaged or cut short: {} bytes, {} were expected", bytes.size(), at.end));
  if (checksum_of(header, bytes.substr(sizeof header, at.sums - sizeof header)) != header.checksum)
    return refuse("is damaged: its checksum is another");
  if (checks_all && hash_of(bytes.substr(at.sums)) != header.sum_checksum)
    return refuse("is damaged: the checksum of its abundances is another");
  SignatureView out;
  if (!read_text(bytes.substr(sizeof header, header.text_bytes), header, out.text))
    return refuse("is damaged: its text lacks a name, bands or columns");
  const std::size_t pairs = signature_pairs(header.cells);
  out.signature = {
      out.text.name,
      header.cells,
      header.bands,
      header.ln_least,
      header.ln_step,
      header.error,
      {reinterpret_cast<const std::uint16_t *>(bytes.data() + at.light), pairs * header.bands * 2}};
  out.abundances = {reinterpret_cast<const float *>(bytes.data() + at.sums),
                    pairs * header.columns};
  return out;
}

Result<void> check_signature_size(std::size_t cells, std::size_t bands) {
  if (cells <= most_cells && bands <= most_bands)
    return {};
  return fail(ErrorCode::Usage,
              fmt::format("{} cells and {} bands: a file of a library holds up to {} cells and {} "
                          "bands. Take fewer, or bands in several libraries",
                          cells, bands, most_cells, most_bands));
}

Result<std::string> signature_bytes(const SignatureText &text, std::size_t cells,
                                    const PackedLight &light, double error,
                                    std::span<const float> abundances) {
  const std::string json = json_of(text);
  Header header{};
  std::memcpy(header.magic, magic, sizeof magic);
  header.byte_order = byte_order;
  header.text_bytes = json.size();
  header.cells = static_cast<std::uint32_t>(cells);
  header.bands = static_cast<std::uint32_t>(text.bands.size());
  header.columns = static_cast<std::uint32_t>(text.columns.size());
  header.ln_least = light.ln_least;
  header.ln_step = light.ln_step;
  header.error = error;
  if (!is_plausible(header)) // what reads it would say that it is damaged
    return fail(ErrorCode::Physics,
                fmt::format("a signature of {} cells, {} bands and {} abundances with ln I from "
                            "{:.3g} in steps of {:.3g} and an error of {:.3g} cannot be kept in a "
                            "file: {} cells, {} bands, {} abundances, |ln I| < {} and an error of "
                            "{:g} are the most",
                            header.cells, header.bands, header.columns, header.ln_least,
                            header.ln_step, header.error, most_cells, most_bands, most_columns,
                            signature_ln_widest, signature_error_most));
  const Places at = places_of(header);
  std::string out(at.end, '\0');
  std::memcpy(out.data() + sizeof header, json.data(), json.size());
  std::memcpy(out.data() + at.light, light.code.data(), light.code.size() * 2);
  if (!abundances.empty())
    std::memcpy(out.data() + at.sums, abundances.data(), abundances.size_bytes());
  const std::string_view all = out;
  header.checksum = checksum_of(header, all.substr(sizeof header, at.sums - sizeof header));
  header.sum_checksum = hash_of(all.substr(at.sums));
  std::memcpy(out.data(), &header, sizeof header);
  return out;
}

Result<SignatureFile> SignatureFile::open(const std::filesystem::path &path, bool checks_all) {
  SignatureFile out;
  UMOV_ASSIGN(mapped, MappedFile::open(path));
  UMOV_ASSIGN(view, parse_signature(mapped.bytes(), path.string(), checks_all));
  out.mapped_ = std::move(mapped);
  out.view_ = std::move(view);
  return out;
}

} // namespace umov
