#include "completion.h"
#include "completion_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace umov::cli {
namespace {

/// For single quotes of fish, where a backslash means something.
std::string fish_quoted(const std::string &text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "'";
}

} // namespace

std::string fish_completion(const VerbFacts &root) {
  std::string lines;
  for (const VerbFacts *verb : all_verbs(root)) {
    const std::string begin =
        fmt::format("complete -c umov -n 'test \"$(__umov_verb)\" = \"{}\"'", verb->path);
    if (!verb->verbs.empty())
      lines += begin + " -f\n";
    for (const VerbFacts &below : verb->verbs)
      lines += fmt::format("{} -a {} -d {}\n", begin, below.name, fish_quoted(below.text));
    for (const OptionFacts &option : verb->options) {
      const std::string choices =
          values_of(option).empty()
              ? ""
              : " -a " + fish_quoted(fmt::format("{}", fmt::join(values_of(option), " ")));
      std::string names;
      for (const std::string &name : option.names)
        names += name.starts_with("--")  ? " -l " + name.substr(2)
                 : name.starts_with("-") ? " -s " + name.substr(1)
                                         : "";
      if (option.is_argument && choices.empty())
        continue; // files, by the default of fish
      const char *value = option.is_argument          ? (option.choices.empty() ? "" : " -f")
                          : option.value.empty()      ? ""
                          : values_of(option).empty() ? " -r -F"
                                                      : " -x";
      lines += begin + names + value + choices + " -d " + fish_quoted(option.text) + "\n";
    }
  }
  std::string cases;
  for (const std::string &path : paths_below(root))
    cases += " '" + path + "'";
  return fmt::format(R"(# Completion of umov for fish, made by `umov completion fish`.
function __umov_verb
    set -l verb umov
    set -l given (commandline -opc)
    for word in $given[2..-1]
        switch "$verb $word"
            case{}
                set verb "$verb $word"
        end
    end
    echo $verb
end
{})",
                     cases, lines);
}

} // namespace umov::cli
