#include "console.h"
#include "verbs.h"

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <execinfo.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <new>
#include <system_error>
#include <umov/core/text.h>
#include <umov/core/version.h>
#include <unistd.h>

namespace {

using namespace umov;

/// Names of all options of a verb and the verbs below it, for "did you mean".
void collect_names(const CLI::App &app, std::vector<std::string> &names) {
  for (const CLI::Option *option : app.get_options())
    for (const std::string &name : option->get_lnames())
      names.push_back("--" + name);
  for (const CLI::App *verb : app.get_subcommands([](const CLI::App *) { return true; }))
    names.push_back(verb->get_name());
}

/// CLI11's Range lets nan pass: no comparison with it holds. No option of umov means it, nor
/// infinity.
void refuse_what_is_no_number(CLI::App &app) {
  const CLI::Validator finite(
      [](std::string &text) {
        const bool is_finite = std::isfinite(std::strtod(text.c_str(), nullptr));
        return is_finite ? std::string() : "a finite number was expected, not " + text;
      },
      std::string());
  for (CLI::Option *option : app.get_options())
    if (option->get_type_name().find("FLOAT") != std::string::npos)
      option->check(finite);
  for (CLI::App *verb : app.get_subcommands([](CLI::App *) { return true; }))
    refuse_what_is_no_number(*verb);
}

const CLI::App &deepest(const CLI::App &app) {
  const auto used = app.get_subcommands();
  return used.empty() ? app : deepest(*used.front());
}

std::vector<std::string> verbs_of(const CLI::App &app) {
  std::vector<std::string> out;
  for (const CLI::App *verb : app.get_subcommands([](const CLI::App *) { return true; }))
    out.push_back(verb->get_name());
  return out;
}

/// The option that a word without one was meant for: elements, or what else a verb cannot do
/// without.
const CLI::Option *option_left_out(const CLI::App &verb) {
  const CLI::Option *const orbit = verb.get_option_no_throw("--orbit");
  if (orbit != nullptr && orbit->count() == 0)
    return orbit;
  for (const CLI::Option *option : verb.get_options())
    if (option->get_required() && option->count() == 0 && !option->get_positional())
      return option;
  return nullptr;
}

int usage_error(const CLI::App &app, const CLI::ParseError &problem) {
  const CLI::App &verb = deepest(app);
  std::string text = problem.what();
  if (const auto left = verb.remaining(); !left.empty()) {
    std::vector<std::string> names;
    collect_names(verb, names);
    const std::string given = left.front().substr(0, left.front().find('='));
    text = fmt::format("unknown {} {}", given.starts_with('-') ? "option" : "argument", given);
    if (const auto near = nearest_name(given, names))
      text += fmt::format(". Did you mean {}?", *near);
    else if (const auto *option = given.starts_with('-') ? nullptr : option_left_out(verb))
      text += fmt::format(". Did you mean {} {}?", option->get_name(), given);
  } else if (const auto verbs = verbs_of(verb); !verbs.empty()) {
    text = fmt::format("no verb was given; there are {}", fmt::join(verbs, ", "));
  } else if (constexpr std::string_view unread = "Could not convert: "; text.starts_with(unread)) {
    // Texts need no conversion.
    text = text.substr(unread.size());
    const auto *option = verb.get_option_no_throw(text.substr(0, text.find(' ')));
    const bool is_whole = option != nullptr && option->get_type_name().find("INT") != text.npos;
    text += is_whole ? "; a whole number was expected" : "; a number was expected";
  } else if (const std::size_t end = text.find('\n'); end != std::string::npos) {
    text.resize(end);
  }
  std::string name = verb.get_name();
  for (const CLI::App *up = verb.get_parent(); up != nullptr; up = up->get_parent())
    name = up->get_name() + " " + name;
  return cli::report(Error{
      ErrorCode::Usage, text + (text.ends_with('?') ? " See " : ". See ") + name + " --help.", {}});
}

int run(int argc, char **argv) {
  CLI::App app{"Polarized light curves of satellites and space debris", "umov"};
  app.set_version_flag("--version", std::string("umov ") + version);
  app.require_subcommand(1);
  int code = 0;
  const cli::Exit exit_with = [&code](int value) { code = value; };
  cli::add_run(app, exit_with);
  cli::add_signature(app, exit_with);
  cli::add_brdf(app, exit_with);
  cli::add_bench(app, exit_with);
  cli::add_material(app, exit_with);
  cli::add_bands(app, exit_with);
  cli::add_mesh(app, exit_with);
  cli::add_observe(app, exit_with);
  cli::add_calibrate(app, exit_with);
  cli::add_reduce(app, exit_with);
  cli::add_exposure(app, exit_with);
  cli::add_instrument(app, exit_with);
  cli::add_invert(app, exit_with);
  cli::add_library(app, exit_with);
  cli::add_identify(app, exit_with);
  cli::add_orbit(app, exit_with);
  cli::add_passes(app, exit_with);
  cli::add_period(app, exit_with);
  cli::add_paper(app, exit_with);
  cli::add_render(app, exit_with);
  cli::add_scale(app, exit_with);
  cli::add_schema(app, exit_with);
  cli::add_doctor(app, exit_with);
  cli::add_completion(app, exit_with);
  cli::add_man(app, exit_with);
  refuse_what_is_no_number(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success &done) { // --help, --version
    return app.exit(done);
  } catch (const CLI::ParseError &problem) {
    return usage_error(app, problem);
  }
  return code;
}

int report_bug(const std::exception &bug) {
  return cli::report(Error{ErrorCode::Internal,
                           std::string("this is a bug of umov: ") + bug.what() +
                               ". Please report it with the command line.",
                           {}});
}

/// A descriptor that the caller closed (`>&-`) would be the next file's: what is printed would
/// stand in a table.
void hold_standard_descriptors() {
  for (int descriptor = 0; descriptor <= STDERR_FILENO; ++descriptor)
    if (::fcntl(descriptor, F_GETFD) < 0) [[maybe_unused]]
      const int held = ::open("/dev/null", descriptor == 0 ? O_WRONLY : O_RDONLY);
}

/// The command; all that ends it but a lack of memory is told.
int run_and_report(int argc, char **argv) {
  try {
    cli::command_line().assign(argv, argv + argc);
    const int code = run(argc, argv);
    const auto printed = cli::flush_output();
    return printed || code != 0 ? code : cli::report(printed.error());
  } catch (const std::bad_alloc &) {
    throw;
  } catch (const Failure &failure) {
    return cli::report(failure.error());
  } catch (const std::system_error &problem) {
    if (problem.code() == std::errc::resource_unavailable_try_again)
      return cli::report(Error{ErrorCode::Device,
                               "no thread could be made; allow more processes (ulimit -u) or "
                               "memory, or ask for fewer with --threads",
                               {}});
    const auto printed = cli::flush_output(); // what fmt::print could not write
    return printed ? report_bug(problem) : cli::report(printed.error());
  } catch (const std::exception &bug) {
    return report_bug(bug);
  }
}

/// JSON and Embree ask for memory to let go of what they hold, where nothing may be thrown: then
/// the program ends at once, but with its word.
std::terminate_handler usual_end = nullptr;
[[noreturn]] void end_without_memory() {
  try {
    if (const auto thrown = std::current_exception())
      std::rethrow_exception(thrown);
  } catch (const std::bad_alloc &) {
    ::_exit(cli::report_out_of_memory());
  } catch (...) {
  }
  usual_end();
  std::abort();
}

} // namespace

int main(int argc, char **argv) {
  std::signal(SIGPIPE, SIG_DFL); // `umov ... | head` ends quietly
  std::signal(SIGXFSZ, SIG_IGN); // a file over the limit is an error of writing
  usual_end = std::set_terminate(end_without_memory);
  // Where an exception leaves std::call_once, glibc loads what unwinds through C, for which it may
  // have no memory by then and ends the program: it is loaded here.
  void *frame = nullptr;
  [[maybe_unused]] const int frames = ::backtrace(&frame, 1);
  hold_standard_descriptors();
  try {
    return run_and_report(argc, argv);
  } catch (const std::bad_alloc &) { // of a message, too
    return cli::report_out_of_memory();
  }
}
