// When an object passes over a site within a day: passes data/tle/hst.tle 20.7,-156.3,3058
#include <cstdio>
#include <umov/umov.h>

umov::Result<void> print_passes(const std::string &file, const std::string &place) {
  umov::Diagnostics warnings;
  UMOV_ASSIGN(text, umov::read_file(file));
  UMOV_ASSIGN(sets, umov::read_elements(text, file, {}, warnings));
  UMOV_ASSIGN(site, umov::site_from(place));
  const umov::Trajectory orbit(sets.front());
  const umov::Epoch<umov::Utc> start = sets.front().epoch;
  UMOV_ASSIGN(found, umov::find_passes(orbit, site, start, umov::plus_seconds(start, 86400), {}));
  for (const umov::SitePass &pass : found.passes)
    std::printf("%s  %4.0f s  up to %2.0f deg  %3.0f %% sunlit\n",
                umov::to_iso(pass.rise.time, 0).c_str(),
                umov::seconds_between(pass.set.time, pass.rise.time),
                pass.culmination.altitude.degrees(), 100 * pass.sunlit_share);
  return {};
}

int main(int argc, char **argv) {
  if (argc != 3)
    return 2;
  const auto done = print_passes(argv[1], argv[2]);
  if (!done)
    std::fprintf(stderr, "%s\n", done.error().text().c_str());
  return done ? 0 : static_cast<int>(done.error().code);
}
