#include "finishing.h"
#include "tables.h"
#include "verbs.h"

#include <umov/jobs/exposure.h>

namespace umov::cli {
namespace {

Result<void> run_exposure(const jobs::ExposureRequest &o, bool has_width, const std::string &output,
                          const std::string &page, const Common &common, Diagnostics &diagnostics) {
  if (has_width && !o.band.empty() && !o.band.starts_with("nm:"))
    return fail(ErrorCode::Usage, "--width-nm beside --band " + o.band +
                                      ": its curve says how wide it is. Leave one out");
  UMOV_TRY(check_page("--page", page));
  UMOV_ASSIGN(table, jobs::exposure(o));
  UMOV_TRY(put_table(output, table, common));
  if (!page.empty()) {
    UMOV_ASSIGN(text, jobs::exposure_page(o));
    UMOV_TRY(put(page, text));
  }
  for (const auto &[key, text] : table.notes())
    if (key == "warning")
      diagnostics.warn(text);
  for (const auto &[key, text] : table.notes())
    if (key == "verdict" || key == "terms" || key == "magnitude")
      note(common, key == "magnitude" ? "magnitude " + text : text);
  return {};
}

} // namespace

void add_exposure(CLI::App &app, const Exit &exit_with) {
  auto *verb =
      app.add_subcommand("exposure", "How long an instrument must expose for an error of p");
  auto o = std::make_shared<jobs::ExposureRequest>();
  auto common = std::make_shared<Common>();
  auto output = std::make_shared<std::string>();
  auto page = std::make_shared<std::string>();
  auto system = std::make_shared<std::string>("AB");
  verb->add_option("--instrument", o->instrument, "Name or file; see umov instrument list")
      ->required();
  const auto number = [&](const char *name, double &value, const char *text) {
    return verb->add_option(name, value, text)->capture_default_str();
  };
  number("--mag", o->mag, "Magnitude above the air");
  verb->add_option("--mag-system", *system, "Of --mag; Vega needs a --band with a curve")
      ->check(CLI::IsMember({"AB", "Vega", "ST"}))
      ->capture_default_str();
  number("--alt", o->altitude_deg, "Apparent altitude [deg]");
  number("--height-m", o->height_m, "Height of the site [m]");
  number("--sd-p", o->sd_p, "Wanted standard deviation of the degree of polarization");
  auto *band = verb->add_option("--band", o->band,
                                "Name or file, as in [bands] set: \"Bessell.V\", \"file:x.vot\"");
  number("--nm", o->nm, "Wavelength [nm], without --band")->excludes(band);
  auto *width = number("--width-nm", o->width_nm,
                       "Width of the band [nm]; of V about 80, of nm:550 in observe 10");
  number("--sky-mag", o->sky_mag, "Sky, AB [mag / arcsec2]");
  number("--seeing", o->seeing_arcsec, "Width of a star at the zenith [arcsec]");
  number("--change-per-s", o->change_per_s, "Relative change of brightness in a second");
  number("--aperture-fwhm", o->aperture_fwhm, "Radius that is summed [widths of a star]");
  number("--exposure-s", o->exposure_s,
         "Of a frame [s]; 0: until p is known, or half of what fills a pixel");
  verb->add_option("--page", *page, "Also a page of figures: x.html");
  add_table_output(*verb, *output);
  add_common(*verb, *common, true);
  verb->callback(finishing(exit_with, common, [=](Diagnostics &diagnostics) {
    o->magnitudes = *system == "Vega" ? MagnitudeSystem::Vega
                    : *system == "ST" ? MagnitudeSystem::ST
                                      : MagnitudeSystem::AB;
    return run_exposure(*o, width->count() > 0, *output, *page, *common, diagnostics);
  }));
}

} // namespace umov::cli
