#include <umov/io/index_file.h>

#include <algorithm>
#include <fmt/format.h>
#include <umov/core/embedded.h>
#include <umov/core/text.h>
#include <umov/surface/material.h>

namespace umov {

const std::vector<EmbeddedFile> &nk_files();

std::vector<std::string> index_names() {
  std::vector<std::string> names = builtin_material_names();
  for (const EmbeddedFile &file : nk_files())
    names.emplace_back(file.stem);
  std::sort(names.begin(), names.end());
  return names;
}

Result<IndexTable> find_index(const std::string &name) {
  for (const EmbeddedFile &file : nk_files())
    if (name == file.stem)
      return read_index_text(std::string(file.bytes), "data/nk/" + name + ".yml");
  if (auto paper = builtin_index(name))
    return paper;
  const auto near = nearest_name(name, index_names());
  return fail(ErrorCode::BadInput,
              fmt::format("unknown index \"{}\".{} Known: umov material index.", name,
                          near ? fmt::format(" Did you mean \"{}\"?", *near) : ""));
}

std::vector<std::string> indices_covering(const std::string &name, Wavelength wavelength) {
  const auto covers = [&](const std::string &one) {
    const auto table = find_index(one);
    return table && index_at(*table, wavelength).has_value();
  };
  const std::string substance = name.substr(0, name.find('_'));
  std::vector<std::string> same, all;
  for (const std::string &one : index_names()) {
    if (one == name || !covers(one))
      continue;
    all.push_back(one);
    // "paper_al" and "Al_Rakic" are one substance as well.
    const std::string other = one.substr(0, one.find('_'));
    if (other == substance)
      same.push_back(one);
  }
  return same.empty() ? all : same;
}

} // namespace umov
