#pragma once
// The command line as data: what --help shows, for completion scripts and the manual page.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace umov::cli {

struct OptionFacts {
  std::vector<std::string> names;   ///< "-o", "--output"; of an argument without dashes: "scene"
  std::string value;                ///< kind of its value, "TEXT"; "" for a flag
  std::vector<std::string> choices; ///< values that there are; empty: any
  std::string text, by_default;     ///< "" without a default
  bool is_argument = false;         ///< stands without a name
  bool is_required = false;
};

struct VerbFacts {
  std::string path; ///< "umov mesh make"
  std::string name, text;
  std::vector<OptionFacts> options;
  std::vector<VerbFacts> verbs;
};

/// The verb and all below it, in the order of the help.
VerbFacts facts_of(const CLI::App &app);

/// The tree as a list, the verb itself first.
std::vector<const VerbFacts *> all_verbs(const VerbFacts &root);

} // namespace umov::cli
