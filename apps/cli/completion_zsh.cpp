#include "completion.h"
#include "completion_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace umov::cli {

std::string zsh_completion(const VerbFacts &root) {
  // Names and texts as _describe takes them: "name:text", with colons of the name escaped.
  const auto described = [](const std::string &name, const std::string &text) {
    return " " + quoted(name + ":" + text);
  };
  std::string values, words;
  for (const VerbFacts *verb : all_verbs(root)) {
    std::string verbs, options;
    for (const VerbFacts &below : verb->verbs)
      verbs += described(below.name, below.text);
    for (const OptionFacts &option : verb->options) {
      if (option.is_argument)
        for (const std::string &choice : values_of(option))
          verbs += described(choice, option.text);
      else
        for (const std::string &name : option.names)
          options += described(name, option.text);
      if (!option.is_argument && !values_of(option).empty())
        values += fmt::format("    ({}) compadd -- {}; return ;;\n",
                              patterns(places(*verb, option)), fmt::join(values_of(option), " "));
    }
    words +=
        fmt::format("    ({}) verbs=({} ); options=({} ) ;;\n", quoted(verb->path), verbs, options);
  }
  return fmt::format(R"(#compdef umov
# Completion of umov for zsh, made by `umov completion zsh`.
_umov() {{
  local verb=umov i
  local -a verbs options
  for ((i = 2; i < CURRENT; ++i)); do
    case "$verb ${{words[i]}}" in
    ({}) verb="$verb ${{words[i]}}" ;;
    esac
  done
  case "$verb ${{words[CURRENT-1]}}" in
{}    ({}) _files; return ;;
  esac
  case "$verb" in
{}  esac
  if [[ $PREFIX == -* ]]; then
    _describe -o option options
  elif (( $#verbs )); then
    _describe verb verbs
  else
    _files
  fi
}}
if [[ $funcstack[1] == _umov ]]; then
  _umov "$@"
else
  compdef _umov umov
fi
)",
                     patterns(paths_below(root)), values, patterns(file_places(root)), words);
}

} // namespace umov::cli
