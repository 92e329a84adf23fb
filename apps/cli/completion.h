#pragma once
// What a shell completes after "umov": scripts made from the command line itself.

#include "command_tree.h"

namespace umov::cli {

std::string bash_completion(const VerbFacts &root);
std::string zsh_completion(const VerbFacts &root);
std::string fish_completion(const VerbFacts &root);

} // namespace umov::cli
