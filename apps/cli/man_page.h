#pragma once
#include "command_tree.h"

namespace umov::cli {

/// The manual page umov.1 (roff with the macros of man): every verb with its options, from the same
/// texts as --help.
std::string man_page(const VerbFacts &root);

} // namespace umov::cli
