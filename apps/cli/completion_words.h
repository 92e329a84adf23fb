#pragma once
// Private to the completion of shells: what may stand where on a command line.

#include "command_tree.h"

namespace umov::cli {

/// For single quotes of bash and zsh.
std::string quoted(const std::string &text);
/// Its patterns for a shell's case: "'umov mesh'|'umov mesh make'"; "" for none.
std::string patterns(const std::vector<std::string> &texts);
/// Values worth offering: those that there are, or names of what an option may also take as a file
/// or as numbers.
std::vector<std::string> values_of(const OptionFacts &option);
/// "umov render --shade" for each name of an option.
std::vector<std::string> places(const VerbFacts &verb, const OptionFacts &option);
/// Paths of all verbs below the root: what the words of a command line may lead to.
std::vector<std::string> paths_below(const VerbFacts &root);
/// All that may stand next: verbs, names of options, choices of arguments.
std::vector<std::string> words_of(const VerbFacts &verb);
/// Places where files are completed: after options that take any value.
std::vector<std::string> file_places(const VerbFacts &root);

} // namespace umov::cli
