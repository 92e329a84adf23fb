#include "completion.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/io/scenario.h>
#include <umov/io/sites.h>

namespace umov::cli {
namespace {

/// For single quotes of bash and zsh.
std::string quoted(const std::string &text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// For single quotes of fish, where a backslash means something.
std::string fish_quoted(const std::string &text) {
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "'";
}

/// Its patterns for a shell's case: "'umov mesh'|'umov mesh make'"; "" for none.
std::string patterns(const std::vector<std::string> &texts) {
  std::vector<std::string> out;
  for (const std::string &text : texts)
    out.push_back(quoted(text));
  return fmt::format("{}", fmt::join(out, "|"));
}

/// Values worth offering: those that there are, or names of what an option may also take as a file
/// or as numbers.
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

/// "umov render --shade" for each name of an option.
std::vector<std::string> places(const VerbFacts &verb, const OptionFacts &option) {
  std::vector<std::string> out;
  for (const std::string &name : option.names)
    out.push_back(verb.path + " " + name);
  return out;
}

/// Paths of all verbs below the root: what the words of a command line may lead to.
std::vector<std::string> paths_below(const VerbFacts &root) {
  std::vector<std::string> out;
  for (const VerbFacts *verb : all_verbs(root))
    if (verb != &root)
      out.push_back(verb->path);
  return out;
}

/// All that may stand next: verbs, names of options, choices of arguments.
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

/// Places where files are completed: after options that take any value.
std::vector<std::string> file_places(const VerbFacts &root) {
  std::vector<std::string> out;
  for (const VerbFacts *verb : all_verbs(root))
    for (const OptionFacts &option : verb->options)
      if (!option.is_argument && !option.value.empty() && values_of(option).empty())
        for (const std::string &place : places(*verb, option))
          out.push_back(place);
  return out;
}

} // namespace

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
