#include "io/scenario/parts.h"

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/embedded.h>
#include <umov/core/files.h>
#include <umov/core/text.h>

namespace umov {

const std::vector<EmbeddedFile> &material_files();

namespace scenario {

Result<Material> library_material(const std::string &name) {
  for (const EmbeddedFile &file : material_files())
    if (name == file.stem)
      return read_material_text(std::string(file.bytes), "data/materials/" + name + ".toml");
  return builtin_material(name);
}

} // namespace scenario

std::vector<std::string> material_library() {
  std::vector<std::string> names, own;
  for (const EmbeddedFile &file : material_files())
    own.emplace_back(file.stem);
  std::sort(own.begin(), own.end());
  names = builtin_material_names();
  names.insert(names.end(), own.begin(), own.end());
  return names;
}

Result<Material> read_material(const std::string &name_or_path) {
  if (name_or_path.ends_with(".toml")) {
    UMOV_ASSIGN(text, read_file(name_or_path));
    return scenario::read_material_text(text, name_or_path);
  }
  auto found = scenario::library_material(name_or_path);
  if (found || scenario::is_in_library(name_or_path))
    return found;
  const auto near = nearest_name(name_or_path, material_library());
  return fail(ErrorCode::BadInput,
              fmt::format("unknown material \"{}\".{} Known: umov material list.", name_or_path,
                          near ? fmt::format(" Did you mean \"{}\"?", *near) : ""));
}

Result<Material> read_material_text(const std::string &text, const std::string &path) {
  return scenario::read_material_text(text, path);
}

bool scenario::is_in_library(const std::string &name) {
  const auto names = material_library();
  return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace umov
