// Dates: of scenarios, elements and CCSDS messages.

#include "fuzz/target.h"

#include <cmath>
#include <umov/time/epoch.h>
#include <umov/time/time_system.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  using namespace umov;
  const std::string_view text = fuzz::text_of(data, size);
  const auto check = [&](const Result<Epoch<Utc>> &time) {
    if (!fuzz::is_read(time))
      return;
    const auto back = utc_from_iso(to_iso_exact(*time));
    fuzz::require(back.has_value(), "a time is written so that it can be read");
    // epoch.h: better than 1 us from 1957 to 2056; a double of days holds less far from there.
    fuzz::require(!(std::abs(seconds_between(*back, *time)) > 1e-6), "and is the same then");
  };
  check(utc_from_iso(text));
  for (const TimeSystem system : {TimeSystem::Utc, TimeSystem::Tai, TimeSystem::Tt, TimeSystem::Gps,
                                  TimeSystem::Tdb, TimeSystem::Ut1})
    check(utc_from_calendar(text, system));
  time_system_from(text);
  return 0;
}
