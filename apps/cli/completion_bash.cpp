#include "completion.h"
#include "completion_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace umov::cli {

std::string bash_completion(const VerbFacts &root) {
  std::string values, words;
  for (const VerbFacts *verb : all_verbs(root)) {
    for (const OptionFacts &option : verb->options)
      if (!option.is_argument && !values_of(option).empty())
        values += fmt::format("    {}) words={} ;;\n", patterns(places(*verb, option)),
                              quoted(fmt::format("{}", fmt::join(values_of(option), " "))));
    words += fmt::format("    {}) words={} ;;\n", quoted(verb->path),
                         quoted(fmt::format("{}", fmt::join(words_of(*verb), " "))));
  }
  return fmt::format(R"(# Completion of umov for bash, made by `umov completion bash`.
_umov() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} verb=umov words='' i
  if [[ $current == '=' ]]; then
    current=''
  elif [[ $before == '=' ]]; then
    before=${{COMP_WORDS[COMP_CWORD-2]}}
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$verb ${{COMP_WORDS[i]}}" in
    {}) verb="$verb ${{COMP_WORDS[i]}}" ;;
    esac
  done
  COMPREPLY=()
  case "$verb $before" in
{}    {}) return ;; # names of files, by the default of bash
    *)
      case "$verb" in
{}      esac
      ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -F _umov umov
)",
                     patterns(paths_below(root)), values, patterns(file_places(root)), words);
}

} // namespace umov::cli
