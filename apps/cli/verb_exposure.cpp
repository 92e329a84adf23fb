#include "tables.h"
#include "verbs.h"

#include <umov/jobs/exposure.h>

namespace umov::cli {

void add_exposure(CLI::App &app, const Exit &exit_with) {
  auto *verb =
      app.add_subcommand("exposure", "How long an instrument must expose for an error of p");
  auto o = std::make_shared<jobs::ExposureRequest>();
  auto common = std::make_shared<Common>();
  auto output = std::make_shared<std::string>();
  verb->add_option("--instrument", o->instrument, "Name or file; see umov instrument list")
      ->required();
  const auto number = [&](const char *name, double &value, const char *text) {
    verb->add_option(name, value, text)->capture_default_str();
  };
  number("--mag", o->mag, "AB magnitude above the air");
  number("--alt", o->altitude_deg, "Apparent altitude [deg]");
  number("--height-m", o->height_m, "Height of the site [m]");
  number("--sd-p", o->sd_p, "Wanted standard deviation of the degree of polarization");
  number("--nm", o->nm, "Wavelength [nm]");
  number("--width-nm", o->width_nm,
         "Width of the band [nm]; of V about 80, of nm:550 in observe 10");
  number("--sky-mag", o->sky_mag, "Sky, AB [mag / arcsec2]");
  number("--seeing", o->seeing_arcsec, "Width of a star at the zenith [arcsec]");
  number("--change-per-s", o->change_per_s, "Relative change of brightness in a second");
  number("--exposure-s", o->exposure_s,
         "Of a frame [s]; 0: until p is known, or half of what fills a pixel");
  add_table_output(*verb, *output);
  add_common(*verb, *common, true);
  verb->callback([=] {
    const auto table = jobs::exposure(*o);
    if (!table) {
      exit_with(report(table.error()));
      return;
    }
    const auto done = put_table(*output, *table, *common);
    for (const auto &[key, text] : table->notes())
      if (done && key == "verdict")
        note(*common, text);
    exit_with(done ? 0 : report(done.error()));
  });
}

} // namespace umov::cli
