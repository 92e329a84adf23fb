#include "man_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <umov/core/result.h>
#include <umov/core/version.h>

namespace umov::cli {
namespace {

/// Text as roff takes it: no command by chance, hyphens that can be copied.
std::string roff(const std::string &text) {
  std::string out;
  bool is_line_start = true;
  for (const char c : text) {
    if (is_line_start && (c == '.' || c == '\''))
      out += "\\&";
    is_line_start = c == '\n';
    out += c == '\\' ? std::string("\\e") : c == '-' ? std::string("\\-") : std::string(1, c);
  }
  return out;
}

/// "\fB-o\fR, \fB--output\fR \fITEXT\fR".
std::string heading(const OptionFacts &option) {
  if (option.is_argument)
    return "\\fI" + roff(option.names.front()) + "\\fR";
  std::string out;
  for (const std::string &name : option.names)
    out += (out.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
  if (option.choices.empty())
    return option.value.empty() ? out : out + " \\fI" + roff(option.value) + "\\fR";
  return out + " " + roff(fmt::format("{}", fmt::join(option.choices, "|")));
}

std::string entry(const OptionFacts &option) {
  std::string out = ".TP\n" + heading(option) + "\n" + roff(option.text);
  if (option.is_required)
    out += ". Required";
  if (!option.by_default.empty())
    out += ". Default: " + roff(option.by_default);
  return out + ".\n";
}

std::string synopsis(const VerbFacts &verb) {
  std::string out = ".B " + roff(verb.path) + "\n";
  for (const OptionFacts &option : verb.options)
    if (option.is_argument)
      out += (option.is_required ? "\\fI" + roff(option.names.front()) + "\\fR"
                                 : "[\\fI" + roff(option.names.front()) + "\\fR]") +
             "\n";
  return out + "[\\fIoptions\\fR]\n";
}

std::string section(const VerbFacts &verb) {
  std::string out = ".SS " + roff(verb.path) + "\n" + roff(verb.text) + ".\n.PP\n" + synopsis(verb);
  for (const OptionFacts &option : verb.options)
    out += entry(option);
  return out;
}

std::string exit_codes() {
  const std::pair<int, const char *> codes[] = {
      {0, "done"},
      {static_cast<int>(ErrorCode::Internal), "a bug of umov"},
      {static_cast<int>(ErrorCode::Usage), "wrong usage"},
      {static_cast<int>(ErrorCode::BadInput), "bad input"},
      {static_cast<int>(ErrorCode::Physics), "physics or numerics: an orbit that ends, a check "
                                             "that fails"},
      {static_cast<int>(ErrorCode::Nothing), "nothing to report, such as no pass"},
      {static_cast<int>(ErrorCode::Device), "a device is missing, or a file cannot be written"},
      {static_cast<int>(ErrorCode::Interrupted), "stopped by the user; what was done is kept"}};
  std::string out;
  for (const auto &[code, text] : codes)
    out += fmt::format(".TP\n{}\n{}.\n", code, roff(text));
  return out;
}

} // namespace

std::string man_page(const VerbFacts &root) {
  std::string out = fmt::format(".TH UMOV 1 \"\" \"umov {}\" \"User Commands\"\n", version);
  out += ".SH NAME\n" + root.name + " \\- " + roff(root.text) + "\n";
  out += ".SH SYNOPSIS\n";
  std::string sections;
  for (const VerbFacts *verb : all_verbs(root)) {
    if (!verb->verbs.empty())
      continue;
    out += synopsis(*verb) + ".br\n";
    sections += section(*verb);
  }
  out += ".SH DESCRIPTION\nTables go to stdout, or with \\fB\\-o\\fR to a file whose suffix says "
         "how; the log goes to stderr, as do warnings and errors.\n";
  out += ".SH COMMANDS\n" + sections;
  out += ".SH EXIT STATUS\n" + exit_codes();
  out += ".SH ENVIRONMENT\n.TP\nNO_COLOR\nIf set, messages have no colour.\n"
         ".TP\nXDG_CACHE_HOME\nMasks of earlier runs are kept in its folder umov, else in "
         "~/.cache/umov.\n"
         ".TP\nUMOV_CUDA_PATH\nFolders, with colons between them, that are looked into first for "
         "libcuda.so.1 and libnvrtc.so.\n";
  return out;
}

} // namespace umov::cli
