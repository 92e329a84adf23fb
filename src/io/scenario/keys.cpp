#include "io/scenario/keys.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <umov/core/text.h>
#include <umov/io/scenario.h>
#include <umov/surface/distribution.h>

namespace umov::scenario {

namespace {

/// The numbers that the distributions take come from the distributions.
std::vector<Key> with_distributions(std::vector<Key> keys) {
  for (const DistributionModel *model : distribution_models())
    for (const DistributionParameter &one : model->parameters) {
      const auto is_there = [&](const Key &key) {
        return std::string_view(key.table) == "material.distribution" &&
               std::string_view(key.name) == one.name;
      };
      if (std::none_of(keys.begin(), keys.end(), is_there))
        keys.push_back({"material.distribution", one.name, Kind::Number, "", one.text});
    }
  return keys;
}

} // namespace

const std::vector<Key> &keys() {
  using enum Kind;
  const LightOptions light; // its defaults are told once, where they stand
  static const Key own[] = {
      {"", "umov", Integer, "", "version of the scenario's form: 1"},
      {"", "title", String, "\"\"", "heading of the report"},
      {"", "seed", Integer, "0", "of every random stream"},
      {"", "observer", Table, "", "the site; absent in a scene"},
      {"", "time", Table, "", "the span; absent in a scene"},
      {"", "earth", Table, "", "how the Earth turns"},
      {"", "object", List, "", "[[object]]: one object"},
      {"", "bands", Table, "", "wavelengths and filters, and the zero of magnitudes"},
      {"", "render", Table, "", "how the light is computed"},
      {"", "instrument_name", String, "",
       "of tables that are here in whole, as in lock files; counts and calibrations have it"},
      {"", "instrument", String, "",
       "a named set of telescope, detector and polarimeter, or a file"},
      {"", "atmosphere", Table, "", "the air over the site; of umov observe"},
      {"", "telescope", Table, "", "what collects the light; over the instrument's"},
      {"", "detector", Table, "", "what measures it"},
      {"", "polarimeter", Table, "", "how Stokes parameters become counts"},
      {"", "observation", Table, "", "exposures of umov observe"},
      {"", "output", Table, "", "what is written"},
      {"", "material", Table, "", "materials written in place: [material.NAME]"},
      {"", "materials", Table, "", "of all materials: what about them is uncertain"},
      {"materials", "vary", List, "[]",
       "what umov run takes over its stated ranges to show the spread of the light: \"haze\""},
      {"observer", "name", String, "\"\"", "name of the site; a known one needs no coordinates"},
      {"observer", "lat_deg", Number, "", "geodetic latitude [deg], north positive"},
      {"observer", "lon_deg", Number, "", "longitude [deg], east positive"},
      {"observer", "alt_m", Number, "", "height above the WGS 84 ellipsoid [m]"},
      {"observer", "atmosphere", Any, "\"none\"",
       "\"clear\", or the numbers of clear air: columns I_obs and mag_obs; [atmosphere] says it "
       "instead. Beside [observation] \"clear\" unless told; \"none\" observes without air"},
      {"observer.atmosphere", "file", String, "",
       "measured extinction instead of the numbers: a table of wavelength_nm and k_mag [mag per "
       "air mass]"},
      {"observer.atmosphere", "pressure_hpa", Number, "", "default: of the site's height"},
      {"observer.atmosphere", "aerosol", Table, "", "dust and haze, as in [atmosphere]"},
      {"observer.atmosphere", "ozone_du", Number, "260.0", "ozone [Dobson units]"},
      {"observer.atmosphere", "water_cm", Number, "0.3", "precipitable water [cm]"},
      {"observer.atmosphere.aerosol", "tau_550", Number, "0.02", "optical depth at 550 nm"},
      {"observer.atmosphere.aerosol", "exponent", Number, "1.3",
       "depth goes with wavelength^-exponent"},
      {"time", "start", Time, "", "first epoch, with Z or an offset; a day alone is its 0 h UTC"},
      {"time", "stop", Time, "", "last epoch, included"},
      {"time", "step_s", Number, "1.0", "step [s]"},
      {"time", "epochs", List, "",
       "instead of these three: times of one's own, in order, a millisecond apart"},
      {"time", "only", Table, "", "which epochs are kept"},
      {"time.only", "alt_min_deg", Number, "0.0", "lowest altitude of the object [deg]"},
      {"time.only", "sun_alt_max_deg", Number, "90.0", "highest altitude of the Sun [deg]"},
      {"time.only", "sunlit", Boolean, "true", "only where some of the Sun is seen"},
      {"earth", "eop", String, "",
       "table of Earth orientation, IERS finals2000A, in place of the compiled-in one"},
      {"object", "name", String, "\"\"", "name of the object"},
      {"object", "orbit", Table, "", "elements; absent in a scene"},
      {"object", "mesh", Table, "", "shape"},
      {"object", "attitude", Table, "{ mode = \"nadir\" }", "which way it points"},
      {"object", "materials", Table, "", "mesh material -> material, and \"default\""},
      {"object", "part", List, "", "[[object.part]]: mesh groups or nodes that turn"},
      {"object.orbit", "file", String, "", "TLE, 3LE, OMM, OEM or OPM file"},
      {"object.orbit", "epoch", Time, "", "of a state written in place of a file"},
      {"object.orbit", "frame", String, "\"gcrs\"", "of the state: gcrs, eme2000, teme or itrs"},
      {"object.orbit", "position_km", List, "", "[x, y, z] [km]"},
      {"object.orbit", "velocity_km_s", List, "", "[x, y, z] [km/s]"},
      {"object.orbit", "norad", Integer, "0", "catalogue number, where the file holds several"},
      {"object.mesh", "file", String, "", "OBJ, glTF, GLB, STL, PLY, COLLADA, 3DS or OFF file"},
      {"object.mesh", "unit", String, "",
       "m, cm, mm, km, in or ft; glTF is in metres where absent"},
      {"object.mesh", "up", String, "",
       "axis of the file that becomes body +Z, such as \"+Y\" (glTF: that, where absent)"},
      {"object.mesh", "normals", String, "\"flat\"", "flat or smooth"},
      {"object.mesh", "crease_deg", Number, "35.0", "edges sharper than this stay sharp [deg]"},
      {"object.attitude", "mode", String, "", "nadir, inertial, spin, tumble, aem or pieces"},
      {"object.attitude", "point", Any, "\"+Z\"", "body axis that points exactly"},
      {"object.attitude", "at", Any, "\"nadir\"",
       "nadir, zenith, velocity, orbit_normal, sun, observer or { ra_deg, dec_deg }"},
      {"object.attitude", "then", Any, "\"+X\"", "second body axis, as near as may be"},
      {"object.attitude", "toward", Any, "\"velocity\"", "where the second axis goes"},
      {"object.attitude", "quaternion", List, "", "body_from_gcrs, [w, x, y, z]"},
      {"object.attitude", "axis", Any, "\"+Z\"", "spin: body axis"},
      {"object.attitude", "rate_deg_s", Any, "",
       "spin: rate [deg/s], right-handed; tumble: [x, y, z] in body axes"},
      {"object.attitude", "period_s", Number, "", "spin: period [s] instead of the rate"},
      {"object.attitude", "epoch", Time, "",
       "spin, tumble: when it has the attitude of `start`; default: time.start"},
      {"object.attitude", "start", Table, "{ mode = \"nadir\" }",
       "spin, tumble: attitude at `epoch`"},
      {"object.attitude", "inertia", Any, "",
       "tumble: \"shell\" or \"solid\" of the mesh, [xx, yy, zz] or [xx, yy, zz, xy, xz, yz]"},
      {"object.attitude", "file", String, "", "aem: CCSDS attitude message"},
      {"object.attitude", "pieces", List, "", "pieces: laws, each with the time `from`"},
      {"object.attitude", "from", Time, "", "of a piece: when it begins"},
      {"object.attitude", "roll_deg", Number, "0.0", "offset about body +X, after pitch [deg]"},
      {"object.attitude", "pitch_deg", Number, "0.0", "offset about body +Y, after yaw [deg]"},
      {"object.attitude", "yaw_deg", Number, "0.0", "offset about body +Z [deg]"},
      {"object.attitude", "libration", Table, "", "small unsteadiness on top"},
      {"object.attitude.libration", "rms_deg", Number, "", "mean square per body axis [deg]"},
      {"object.attitude.libration", "period_s", Number, "60.0", "typical period [s]"},
      {"object.part", "name", String, "\"\"", "for messages and `on`"},
      {"object.part", "groups", List, "[]", "mesh groups that turn together"},
      {"object.part", "nodes", List, "[]",
       "instead or as well: nodes of a glTF tree, with all below"},
      {"object.part", "axis", Any, "\"+Y\"", "body axis that they turn about"},
      {"object.part", "pivot_m", List, "[0, 0, 0]", "a point of the axis [m]"},
      {"object.part", "face", Any, "\"+Z\"", "what is turned towards a target, as in the mesh"},
      {"object.part", "toward", Any, "\"sun\"",
       "nadir, zenith, velocity, orbit_normal, sun, observer, { ra_deg, dec_deg } or a place"},
      {"object.part", "angle_deg", Any, "", "instead: an angle, or a list with `time`"},
      {"object.part", "time", List, "", "times of the angles"},
      {"object.part", "on", String, "\"\"", "the part that carries this one"},
      {"direction", "ra_deg", Number, "", "right ascension, GCRS [deg]"},
      {"direction", "lat_deg", Number, "", "a place on the Earth: latitude [deg]"},
      {"direction", "lon_deg", Number, "", "longitude [deg], east positive"},
      {"direction", "alt_m", Number, "0.0", "height above the ellipsoid [m]"},
      {"direction", "dec_deg", Number, "", "declination, GCRS [deg]"},
      {"sides", "front", String, "", "material of the side that the winding faces"},
      {"sides", "back", String, "", "material of the other side"},
      {"bands", "set", Any, "\"paper_rgb\"",
       "a name or a list of them: \"nm:NUMBER\", \"paper_rgb\", curves (\"Bessell.V\", "
       "\"gaia\"; see umov bands list), \"file:x.vot\" or { file, unit, detector }"},
      {"bands", "mag_system", String, "\"AB\"",
       "AB, ST or Vega (the latter where a band has a zero point)"},
      {"bands.set", "file", String, "",
       "curve of a band: VOTable of the SVO Filter Profile Service, or columns wavelength, "
       "response"},
      {"bands.set", "unit", String, "",
       "of its wavelengths: nm, um or Angstrom; absent: the file says"},
      {"bands.set", "detector", String, "",
       "photon or energy: what the curve multiplies; absent: the file says"},
      {"render", "bounces", Integer, fmt::format("{}", light.bounces),
       "surfaces that the light may touch, 1 to 64; 1: direct light"},
      {"render", "between", String, fmt::format("\"{}\"", name_of(light.between)),
       "how light of more than one surface is drawn: paths for each pose, chains once for the "
       "body, "
       "or auto: chains for many poses far apart, else paths"},
      {"render", "sun", String, "\"disk\"", "disk (695,700 km at its distance) or point"},
      {"render", "method", String, fmt::format("\"{}\"", name_of(light.method)),
       "how hiding is decided: rays, masks, or auto: masks mended by rays to the accuracy asked"},
      {"render", "accuracy", Number, shortest(light.accuracy),
       "relative 95 % half-width asked of I; where it does not stand, signature asks with auto for "
       "0.05, at a floor of 0.02"},
      {"render", "accuracy_floor", Number, shortest(default_accuracy_floor(light.method)),
       "in parts of the object's typical light: below it I need not be known any better than at "
       "it; 0 with rays and masks"},
      {"render", "earthshine", Table, "",
       "light of the Earth, in columns of its own; absent: none"},
      {"render", "moonlight", Boolean, "false", "light of the Moon, in columns of its own"},
      {"render", "shadow_edge", String, "\"geometric\"",
       "geometric, or refracted: sunlight bent, dimmed and reddened by the Earth's air"},
      {"render.earthshine", "albedo", Number, "0.3", "of a Lambert Earth"},
      {"render.earthshine", "patches", Integer, "200",
       "sources that the Earth's disk is cut into to begin with; 100 times as many at most"},
      {"render.earthshine", "accuracy", Number, "0.02",
       "relative 95 % half-width asked of earth_I"},
      {"atmosphere", "file", String, "",
       "measured extinction instead of the numbers: a table of wavelength_nm and k_mag [mag per "
       "air mass]"},
      {"atmosphere", "pressure_hpa", Number, "", "default: of the site's height"},
      {"atmosphere", "aerosol", Table, "", "dust and haze"},
      {"atmosphere", "ozone_du", Number, "260.0", "ozone [Dobson units]"},
      {"atmosphere", "water_cm", Number, "0.3", "precipitable water [cm]"},
      {"atmosphere", "seeing", Table, "", "width of a star's image"},
      {"atmosphere", "scintillation", Any, "", "\"none\", or a table"},
      {"atmosphere", "sky", Table, "", "light of the sky"},
      {"atmosphere", "cloud", Table, "", "transparency that wanders"},
      {"atmosphere.aerosol", "tau_550", Number, "0.02", "optical depth at 550 nm"},
      {"atmosphere.aerosol", "exponent", Number, "1.3", "depth goes with wavelength^-exponent"},
      {"atmosphere.seeing", "arcsec", Number, "1.0", "full width at half maximum, zenith [arcsec]"},
      {"atmosphere.seeing", "at_nm", Number, "500.0", "of that width [nm]"},
      {"atmosphere.seeing", "outer_scale_m", Number, "25.0", "of turbulence [m]; 0: infinite"},
      {"atmosphere.seeing", "profile", String, "\"moffat\"", "moffat (exponent 4.765) or gauss"},
      {"atmosphere.scintillation", "model", String, "\"osborn2015\"", "osborn2015 or none"},
      {"atmosphere.scintillation", "c_y", Number, "1.5", "of the site, 1.3 to 1.67"},
      {"atmosphere.scintillation", "slew", Boolean, "false", "less while following fast objects"},
      {"atmosphere.sky", "dark_mag", Table, "", "moonless zenith by letter, as { V = 21.6 }"},
      {"atmosphere.sky.dark_mag", "U", Number, "22.3", "[mag / arcsec2], Vega system"},
      {"atmosphere.sky.dark_mag", "B", Number, "22.6", "[mag / arcsec2], Vega system"},
      {"atmosphere.sky.dark_mag", "V", Number, "21.6", "[mag / arcsec2], Vega system"},
      {"atmosphere.sky.dark_mag", "R", Number, "20.9", "[mag / arcsec2], Vega system"},
      {"atmosphere.sky.dark_mag", "I", Number, "19.7", "[mag / arcsec2], Vega system"},
      {"atmosphere.sky", "twilight", String, "\"patat2006\"", "patat2006 or none"},
      {"atmosphere.sky", "moon", String, "\"ks1991\"", "ks1991 or none"},
      {"atmosphere.sky", "dilution", Table, "", "of the polarization of single scattering"},
      {"atmosphere.sky.dilution", "sun", Number, "0.8", "in twilight"},
      {"atmosphere.sky.dilution", "moon", Number, "0.6", "by moonlight"},
      {"atmosphere.sky", "mag", Number, "", "instead: fixed, AB in the band [mag / arcsec2]"},
      {"atmosphere.sky", "p", Number, "0.0", "with mag: degree of polarization, as by the Sun"},
      {"atmosphere.cloud", "sd_mag", Number, "0.0", "standard deviation [mag]"},
      {"atmosphere.cloud", "time_s", Number, "60.0", "correlation time [s]"},
      {"telescope", "aperture_m", Number, "", "diameter [m]"},
      {"telescope", "obstruction", Number, "0.0", "of the diameter"},
      {"telescope", "focal_length_m", Number, "", "[m]"},
      {"telescope", "throughput", Any, "1.0",
       "optics times detector, without polarizers: a number or { wavelength_nm, value }"},
      {"telescope", "port", Any, "\"cassegrain\"",
       "cassegrain, nasmyth_left, nasmyth_right, or { mirrors, x_from }: where flat mirrors send "
       "the "
       "light, left or right (along the altitude axis) at first, then up, down, left, right, "
       "forward "
       "or back of the fork, and north, east, south or west behind the azimuth axis; { to, mirror "
       "} "
       "gives one its metal"},
      {"telescope.port", "mirrors", List, "",
       "where each sends the light, or tables { to, mirror }"},
      {"telescope.port.mirrors", "to", String, "", "where it sends the light"},
      {"telescope.port.mirrors", "mirror", String, "",
       "index of this one; default: telescope.mirror"},
      {"telescope.port", "x_from", String, "",
       "where x_axis_deg is counted from; default: up of a level beam, forward of a vertical one"},
      {"telescope", "mirror", String, "\"Al_Rakic\"", "index of the flat mirrors of the port"},
      {"telescope", "mount", String, "\"altaz\"", "altaz or equatorial"},
      {"telescope", "derotator", Boolean, "false", "the instrument turns with the sky"},
      {"telescope", "tracking", String, "\"satellite\"",
       "what is followed, satellite, sidereal or fixed: the rest trails"},
      {"telescope", "tracking_error_arcsec", Number, "1.0",
       "frames: of the place of each, standard deviation [arcsec]"},
      {"detector", "model", String, "\"ideal\"", "ideal, ccd, cmos, emccd or counter"},
      {"detector", "pixel_um", Number, "", "side of a pixel [um]"},
      {"detector", "size_px", List, "", "columns and rows"},
      {"detector", "read_e", Number, "0.0", "reading noise of a pixel [electron]"},
      {"detector", "dark_e_s", Number, "0.0", "dark current of a pixel [electron / s]"},
      {"detector", "gain_e_adu", Number, "1.0", "electrons for one number"},
      {"detector", "bits", Integer, "16", "of a number"},
      {"detector", "bias_adu", Number, "100.0", "number of an empty pixel"},
      {"detector", "well_e", Number, "0.0", "full well [electron]; 0: none"},
      {"detector", "nonlinearity", Number, "0.0", "a full well reads 1 minus this of itself"},
      {"detector", "shutter", String, "\"global\"", "global or rolling"},
      {"detector", "line_time_s", Number, "", "of a rolling shutter [s]"},
      {"detector", "em_gain", Number, "1.0", "of an emccd"},
      {"detector", "dead_time_s", Number, "0.0", "of a counter [s]"},
      {"detector", "paralyzable", Boolean, "false", "photons that a counter misses prolong it"},
      {"polarimeter", "type", String, "\"none\"",
       "none, polarizer_wheel, hwp_dual_beam, spinning_hwp_dual_beam, rotating_retarder, pem, flc, "
       "four_camera or mosaic"},
      {"polarimeter", "layout", List, "", "mosaic: rows of angles, such as [[90, 45], [135, 0]]"},
      {"polarimeter", "angles_deg", List, "", "four_camera: of each camera's analyser"},
      {"polarimeter", "extinction", Any, "",
       "of the analysers: a number or { wavelength_nm, value }; default: perfect"},
      {"polarimeter", "retardance_deg", Any, "180.0",
       "of the plate: a number or { wavelength_nm, value }"},
      {"polarimeter", "plate_zero_deg", Number, "0.0", "added to every angle of the plate"},
      {"polarimeter", "period_s", Number, "", "of a turn of a spinning plate [s]"},
      {"polarimeter", "pupils", String, "\"common\"", "four_camera: common, or separate lenses"},
      {"polarimeter", "x_axis_deg", Number, "",
       "of the instrument, from the zenith direction (altaz) or north (equatorial or derotated), "
       "counter-clockwise on the sky"},
      {"polarimeter", "q0", Number, "0.0", "own polarization, which the reduction does not know"},
      {"polarimeter", "u0", Number, "0.0", "the same of u"},
      {"observation", "bands", Any, "", "as [bands] set; default: those"},
      {"observation", "width_nm", Number, "10.0", "of a band that is one wavelength [nm]"},
      {"observation", "exposure_s", Number, "1.0", "[s]"},
      {"observation", "cadence_s", Number, "", "from begin to begin [s]; default: exposure_s"},
      {"observation", "sequence", List, "", "of tables { analyser_deg | plate_deg, band }"},
      {"observation.sequence", "analyser_deg", Number, "0.0", "angle of the analyser"},
      {"observation.sequence", "plate_deg", Number, "0.0", "angle of the plate"},
      {"observation.sequence", "band", String, "\"\"", "default: all bands in turn"},
      {"observation", "aperture_fwhm", Number, "2.0", "radius that is summed, in widths of a star"},
      {"observation", "level", String, "\"aperture\"",
       "aperture: counts per channel; image: frames as FITS, and counts from them"},
      {"observation", "frame_px", List, "[256, 256]",
       "columns and rows of a frame, about the object"},
      {"observation", "stars", String, "",
       "of the field: a file with ra_deg, dec_deg (ICRS, of the date) and mag (AB in the band)"},
      {"observation", "photometry", String, "\"aperture\"",
       "of frames: aperture, or image: fitted by the star's, for each orientation"},
      {"observation", "trail", String, "\"whole\"",
       "frames: whole, or slices: a set of rows for each piece of a trail as long as a star is "
       "wide"},
      {"observation", "clock_error_s", Number, "0.001", "of the time stamps, constant in a run"},
      {"calibration_file", "instrument", String, "", "that was calibrated"},
      {"calibration_file", "band", String, "", "in which"},
      {"calibration_file", "pol_frame", String, "", "frame of the counts"},
      {"calibration_file", "made_utc", String, "", "time of the last standard"},
      {"calibration_file", "efficiency", Number, "", "of linear polarization"},
      {"calibration_file", "phi0_deg", Number, "", "angle that the x axis is off"},
      {"calibration_file", "q0", Number, "", "own polarization, instrument's axes"},
      {"calibration_file", "u0", Number, "", "the same of u"},
      {"calibration_file", "efficiency_sd", Number, "", "standard deviation"},
      {"calibration_file", "q0_sd", Number, "", "standard deviation of q0 and of u0"},
      {"calibration_file", "chi2", Number, "", "of the fit"},
      {"calibration_file", "dof", Integer, "", "its degrees of freedom"},
      {"calibration_file", "photometry", Table, "",
       "of brightness, by standards of known magnitude"},
      {"calibration_photometry", "zero_mag", Number, "",
       "what the zero point of the counts is off"},
      {"calibration_photometry", "k_mag", Number, "", "extinction per air mass"},
      {"calibration_photometry", "colour_term", Number, "",
       "taken off, per unit of the colour index"},
      {"calibration_photometry", "k2_mag", Number, "0",
       "k'' of second order: what colour and air mass add together"},
      {"calibration_photometry", "residual_mag", Number, "", "standard deviation of what is left"},
      {"calibration_photometry", "covariance", List, "",
       "of these four in their order, 16 numbers row by row"},
      {"curve", "wavelength_nm", List, "", "[nm], increasing"},
      {"curve", "value", List, "", "at those wavelengths"},
      {"instrument_file", "description", String, "", "what it is"},
      {"instrument_file", "source", String, "", "where its numbers come from"},
      {"instrument_file", "assumed", String, "", "what is not published and was assumed"},
      {"instrument_file", "telescope", Table, "", "as in a scenario"},
      {"instrument_file", "detector", Table, "", "as in a scenario"},
      {"instrument_file", "polarimeter", Table, "", "as in a scenario"},
      {"output", "dir", String, "\"out\"", "folder, relative to the working folder"},
      {"output", "csv_digits", String, "\"error\"",
       "of lightcurve.csv: error (two digits of each number's error) or all; other forms have all"},
      {"output", "keep_inputs", Boolean, "false",
       "copies of all inputs in the folder, for scenario.lock.toml to run anywhere"},
      {"output", "formats", List, "[\"ecsv\", \"html\"]", "ecsv, csv, fits, html"},
      {"output", "pol_frame", String, "\"equatorial\"", "equatorial, altaz or scattering"},
      {"material", "index", Any, "",
       "name, file (.yml .csv .txt .dat), { file }, { n, k } or { wavelength_nm, n, k }"},
      {"material", "layers", List, "", "films on the substrate, first on top"},
      {"material", "distribution", Table, "", "of microfacet normals"},
      {"material", "direction", Any, "",
       "direction field of ashikhmin_shirley: a body axis such as \"+X\", or \"uv\""},
      {"material", "shadowing", String, "\"ashikhmin\"",
       "ashikhmin, smith, smith_directional or separable"},
      {"material", "body", Table, "", "light scattered below the surface; absent: none"},
      {"material", "haze", Table, "",
       "floor under all lobes: part of the area that reflects like a Lambert surface; absent: "
       "none"},
      {"material", "interreflection", String, "\"none\"",
       "between microfacets: none, unpolarized or single_bounce_q"},
      {"material", "apparent_roughness", Table, "",
       "absent: the same roughness at every wavelength"},
      {"material", "table", String, "", "measured BRDF (CSV), instead of all of the above"},
      {"material", "accept", Boolean, "false", "take a measured table that is not physical"},
      {"material", "description", String, "", "what it is"},
      {"material", "source", String, "", "where its numbers come from"},
      {"material", "assumed", String, "", "what is not known and was assumed"},
      {"material.index", "file", String, "",
       "page of refractiveindex.info (YAML), or columns of wavelength, n and k"},
      {"material.index", "n", Any, "", "real part, a number or a list"},
      {"material.index", "k", Any, "0.0", "imaginary part (n + ik, k >= 0 absorbs)"},
      {"material.index", "wavelength_nm", List, "", "wavelengths of the lists [nm]"},
      {"material.layers", "index", Any, "", "as the material's"},
      {"material.layers", "thickness_nm", Number, "", "[nm]"},
      {"material.layers", "coherent", Boolean, "true", "false: too thick to interfere"},
      {"material.apparent_roughness", "hurst", Number, "",
       "Hurst exponent of the surface, 0.3 to 1: smoother at longer wavelengths"},
      {"material.apparent_roughness", "reference_nm", Number, "550.0",
       "wavelength at which the distribution holds [nm]"},
      {"material.apparent_roughness", "rms_height_nm", Number, "",
       "polished surface: part of the light sees a mirror [nm]"},
      {"material.body", "reflectance", Any, "",
       "R_sub: a number or { wavelength_nm, reflectance }"},
      {"material.body", "polarized", Boolean, "false", "p-polarized by the way out (Baek 2018)"},
      {"material.body.reflectance", "wavelength_nm", List, "", "[nm]"},
      {"material.body.reflectance", "reflectance", List, "", "0 to 1"},
      {"material.haze", "share", Number, "",
       "of the area, reflecting as much as the interface does on average"},
      {"material.haze", "albedo", Number, "", "of all light, whatever the interface reflects"},
      {"material.haze", "polarized", Boolean, "false",
       "beside share: with the Q/I of one reflection"},
      {"material.haze", "range", List, "", "smallest and largest value that it may have"},
      {"material.distribution", "model", String, "", "see umov material list --models"},
      {"material.distribution", "file", String, "",
       "model table: CSV with columns theta_deg, density"},
  };
  static const std::vector<Key> all = with_distributions({std::begin(own), std::end(own)});
  return all;
}

std::vector<std::string> names_in(std::string_view table) {
  std::vector<std::string> out;
  for (const Key &key : keys())
    if (table == key.table)
      out.emplace_back(key.name);
  return out;
}

const Key *find_key(std::string_view table, std::string_view name) {
  for (const Key &key : keys())
    if (table == key.table && name == key.name)
      return &key;
  return nullptr;
}

const char *to_text(Kind kind) {
  switch (kind) {
  case Kind::String:
    return "a string";
  case Kind::Number:
    return "a number";
  case Kind::Integer:
    return "a whole number";
  case Kind::Boolean:
    return "true or false";
  case Kind::Time:
    return "a time such as 2018-01-21T04:00:00Z";
  case Kind::List:
    return "a list";
  case Kind::Table:
    return "a table";
  case Kind::Any:
    break;
  }
  return "a value";
}

namespace {

nlohmann::ordered_json schema_of(std::string_view table) {
  nlohmann::ordered_json out{{"type", "object"}, {"additionalProperties", false}};
  for (const Key &key : keys()) {
    if (table != key.table)
      continue;
    nlohmann::ordered_json entry{{"description", key.text}};
    const std::string below = std::string(table) + (table.empty() ? "" : ".") + key.name;
    switch (key.kind) {
    case Kind::Number:
      entry["type"] = "number";
      break;
    case Kind::Integer:
      entry["type"] = "integer";
      break;
    case Kind::Boolean:
      entry["type"] = "boolean";
      break;
    case Kind::Time:
      entry["type"] = "string";
      entry["format"] = "date-time";
      break;
    case Kind::String:
      entry["type"] = "string";
      break;
    case Kind::List:
      entry["type"] = "array";
      if (below == "object" || below == "material.layers" || below == "object.part" ||
          below == "observation.sequence")
        entry["items"] = schema_of(below);
      if (below == "time.epochs") {
        entry["items"] = {{"type", "string"}, {"format", "date-time"}};
        entry["minItems"] = 1;
      }
      break;
    case Kind::Table:
      if (below == "material")
        entry["additionalProperties"] = schema_of("material");
      else if (!names_in(below).empty())
        entry.update(schema_of(below));
      else
        entry["type"] = "object";
      break;
    case Kind::Any:
      break;
    }
    if (!key.fallback.empty() && key.fallback[0] != '{')
      entry["default"] = nlohmann::ordered_json::parse(key.fallback);
    out["properties"][key.name] = std::move(entry);
  }
  return out;
}

} // namespace
} // namespace umov::scenario

namespace umov {

std::string scenario_schema_json() {
  nlohmann::ordered_json out{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                             {"title", "umov scenario"}};
  out.update(scenario::schema_of(""));
  return out.dump(2) + "\n";
}

} // namespace umov
