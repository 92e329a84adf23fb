#include "verb_material.h"

#include <filesystem>
#include <fmt/format.h>
#include <umov/core/files.h>
#include <umov/core/text.h>
#include <umov/io/index_file.h>
#include <umov/io/measured_file.h>

namespace umov::cli {
namespace {

struct ImportOptions {
  std::string file, name, output;
  bool accept = false;
};

/// A page of refractiveindex.info or a measured BRDF, checked, as a material file beside it.
Result<void> import_file(const ImportOptions &o, const Common &common) {
  namespace fs = std::filesystem;
  const fs::path source = o.file;
  const std::string name = o.name.empty() ? source.stem().string() : o.name;
  const fs::path target =
      o.output.empty() ? source.parent_path() / (name + ".toml") : fs::path(o.output);
  const std::string beside =
      fs::proximate(source, target.has_parent_path() ? target.parent_path() : ".").string();
  std::string text;
  UMOV_ASSIGN(bytes, read_file(source, 16u << 20));
  if (source.extension() == ".csv" && bytes.find("theta") != std::string::npos) {
    std::vector<std::string> remarks;
    UMOV_ASSIGN(measured, read_measured_file(source, o.accept, remarks));
    text = fmt::format("[material.\"{}\"]\ndescription = \"measured, {}\"\ntable = \"{}\"\n{}",
                       name, measured.has_polarization() ? "Mueller" : "brightness only", beside,
                       o.accept ? "accept = true\n" : "");
    for (const std::string &remark : remarks)
      note(common, "remark: " + remark);
  } else {
    UMOV_ASSIGN(index, read_index_file(source));
    text =
        fmt::format("[material.\"{}\"]\nsource = \"{}\"\nassumed = \"roughness\"\n"
                    "index = {{ file = \"{}\" }}\ndistribution = {{ model = \"beckmann\", alpha = "
                    "0.1 }}\n",
                    name, index.reference, beside);
  }
  if (std::error_code code; fs::exists(target, code))
    return fail(ErrorCode::Device, "stands there already; name another file with -o",
                {target.string()});
  UMOV_TRY(write_file_atomically(target, text));
  if (!common.quiet)
    fmt::print("written to {}; umov material show {}\n", printable(target.string()),
               printable(target.string()));
  return {};
}

} // namespace

void add_import(CLI::App &material, const Exit &exit_with) {
  auto *verb = material.add_subcommand("import", "Check n and k (a page of refractiveindex.info, "
                                                 "or columns wavelength, n, k) or a measured BRDF "
                                                 "(.csv with theta_i_deg), as a material");
  auto o = std::make_shared<ImportOptions>();
  auto common = std::make_shared<Common>();
  verb->add_option("file", o->file, "Input")->required();
  verb->add_option("--name", o->name, "Name of the material; default: that of the file");
  verb->add_option("-o,--output", o->output, "TOML file; default: beside the input");
  verb->add_flag("--accept", o->accept,
                 "Take a measured table that is not physical, with a warning");
  add_common(*verb, *common, false);
  verb->callback(finishing(exit_with, [o, common] { return import_file(*o, *common); }));
}

} // namespace umov::cli
