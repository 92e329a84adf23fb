#include "completion_words.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/io/scenario.h>
#include <umov/io/sites.h>

namespace umov::cli {

std::string quoted(const std::string &text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string patterns(const std::vector<std::string> &texts) {
  std::vector<std::string> out;
  for (const std::string &text : texts)
    out.push_back(quoted(text));
  return fmt::format("{}", fmt::join(out, "|"));
}

std::vector<std::string> values_of(const OptionFacts &option) {
  if (!option.choices.empty())
    return option.choices;
  const auto is_called = [&](const char *name) {
    return std::find(option.names.begin(), option.names.end(), name) != option.names.end();
  };
  std::vector<std::string> out;
  if (is_called("--site"))
    out = site_names();
  if (option.is_argument && is_called("material"))
    out = material_library();
  for (std::string &name : out)
    std::replace(name.begin(), name.end(), ' ', '-'); // sites are known by either
  return out;
}

std::vector<std::string> places(const VerbFacts &verb, const OptionFacts &option) {
  std::vector<std::string> out;
  for (const std::string &name : option.names)
    out.push_back(verb.path + " " + name);
  return out;
}

std::vector<std::string> paths_below(const VerbFacts &root) {
  std::vector<std::string> out;
  for (const VerbFacts *verb : all_verbs(root))
    if (verb != &root)
      out.push_back(verb->path);
  return out;
}

std::vector<std::string> words_of(const VerbFacts &verb) {
  std::vector<std::string> out;
  for (const VerbFacts &below : verb.verbs)
    out.push_back(below.name);
  for (const OptionFacts &option : verb.options) {
    const auto words = option.is_argument ? values_of(option) : option.names;
    out.insert(out.end(), words.begin(), words.end());
  }
  return out;
}

std::vector<std::string> file_places(const VerbFacts &root) {
  std::vector<std::string> out;
  for (const VerbFacts *verb : all_verbs(root))
    for (const OptionFacts &option : verb->options)
      if (!option.is_argument && !option.value.empty() && values_of(option).empty())
        for (const std::string &place : places(*verb, option))
          out.push_back(place);
  return out;
}

} // namespace umov::cli
