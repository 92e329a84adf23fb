#include "command_tree.h"

#include <umov/core/text.h>

namespace umov::cli {
namespace {

/// "{I,p,pa}" of "TEXT:{I,p,pa}": the only place where CLI11 tells what IsMember takes.
std::vector<std::string> choices_of(const std::string &type) {
  const std::size_t begin = type.find('{'), end = type.find('}', begin);
  std::vector<std::string> out;
  if (begin == std::string::npos || end == std::string::npos)
    return out;
  for (std::size_t at = begin + 1; at <= end;) {
    const std::size_t next = std::min(type.find(',', at), end);
    out.push_back(type.substr(at, next - at));
    at = next + 1;
  }
  return out;
}

OptionFacts facts_of(const CLI::Option &option) {
  OptionFacts out;
  for (const std::string &name : option.get_snames())
    out.names.push_back("-" + name);
  for (const std::string &name : option.get_lnames())
    out.names.push_back("--" + name);
  out.is_argument = !option.nonpositional();
  if (out.is_argument)
    out.names = {option.get_name(true)};
  const std::string type = option.get_type_name();
  out.choices = choices_of(type);
  if (option.get_items_expected_max() > 0) {
    out.value = type.substr(0, std::min(type.find(':'), type.find(" in ")));
    if (out.value.empty())
      out.value = "TEXT";
  }
  out.text = option.get_description();
  out.by_default = option.get_default_str();
  out.is_required = option.get_required();
  return out;
}

void collect(const VerbFacts &verb, std::vector<const VerbFacts *> &out) {
  out.push_back(&verb);
  for (const VerbFacts &below : verb.verbs)
    collect(below, out);
}

} // namespace

VerbFacts facts_of(const CLI::App &app) {
  VerbFacts out;
  out.name = out.path = app.get_name();
  for (const CLI::App *up = app.get_parent(); up != nullptr; up = up->get_parent())
    out.path = up->get_name() + " " + out.path;
  out.text = app.get_description();
  for (const CLI::Option *option : app.get_options())
    out.options.push_back(facts_of(*option));
  for (const CLI::App *below : app.get_subcommands([](const CLI::App *) { return true; }))
    out.verbs.push_back(facts_of(*below));
  return out;
}

std::vector<const VerbFacts *> all_verbs(const VerbFacts &root) {
  std::vector<const VerbFacts *> out;
  collect(root, out);
  return out;
}

} // namespace umov::cli
