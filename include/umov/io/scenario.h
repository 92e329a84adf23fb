#pragma once
// The scenario file: what a run is about.

#include <atomic>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <umov/attitude/attitude.h>
#include <umov/core/diagnostics.h>
#include <umov/io/observation.h>
#include <umov/io/passband_file.h>
#include <umov/lightcurve/compute.h>
#include <umov/orbit/state_vector.h>
#include <umov/orbit/trajectory.h>
#include <umov/scene/scene.h>
#include <vector>

namespace umov {

/// [time]: the span and which of its epochs are kept.
struct ScenarioTime {
  Epoch<Utc> start{}, stop{};
  double step_s = 1;              ///< of own epochs: the shortest between two
  std::vector<Epoch<Utc>> epochs; ///< of one's own, in place of even steps; empty: none
  EpochFilter only;

  /// As jobs take it.
  [[nodiscard]] EpochSpan span() const { return {start, stop, step_s, epochs}; }
};

/// A file, or a state written in place.
struct ScenarioOrbit {
  std::filesystem::path file;
  int norad = 0; ///< 0: the only object of the file
  std::optional<StateVector> state;
};

/// The mesh of an object, as its file has it.
struct ScenarioMesh {
  std::filesystem::path file; ///< empty: the scenario says only where the object was
  std::string unit, up;
  NormalMode normals = NormalMode::Flat;
  double crease_deg = 35; ///< for meshes without vertex normals
};

/// Names of the materials of both sides of a mesh group.
struct MaterialNames {
  std::string front, back;
};

/// One [[object]].
struct ScenarioObject {
  std::string name;
  std::optional<ScenarioOrbit> orbit;
  ScenarioMesh mesh;
  AttitudeLaw attitude = TwoAxisLaw{};
  bool has_assumed_epoch =
      false;                ///< a spin or tumble that begins at time.start for want of `epoch`
  bool lacks_epoch = false; ///< of a scene: nor is there a time.start. Its attitude is known at no
                            ///< time, and its light from any direction all the same
  std::map<std::string, MaterialNames> materials; ///< mesh material, or "default"
  std::vector<MovingJoint> parts;
};

/// An input file and the hash of what was read.
struct InputFile {
  std::string path, sha256;
};

/// A scenario with all defaults filled in. A scene (for `umov signature`) has no orbit, time and
/// observer. Relative paths have been resolved against the folder of the scenario.
struct Scenario {
  std::string file, title;
  std::uint64_t seed = 0;
  std::optional<Site> observer;
  std::optional<SiteAir> air; ///< [observer] atmosphere, or [atmosphere]; absent: none
  std::optional<ScenarioTime> time;
  std::filesystem::path earth_orientation; ///< table in place of the compiled-in one; empty: that
  std::vector<ScenarioObject> objects;     ///< at least one
  std::map<std::string, Material> own_materials; ///< the [material.NAME] tables
  bool varies_haze =
      false; ///< [materials] vary: `umov run` shows the spread over the ranges of haze
  std::vector<BandEntry> band_set{{"paper_rgb", {}}}; ///< as [bands] names them
  std::vector<Band> bands;
  std::vector<InputFile> band_files; ///< curves of bands and air that were read
  MagnitudeSystem magnitudes = MagnitudeSystem::AB;
  LightOptions light; ///< method, accuracy and its floor, bounces
  std::optional<EarthshineOptions> earthshine;
  bool has_moonlight = false, has_refracted_shadow = false;
  bool has_solar_disk = true;              ///< false: a point Sun
  std::filesystem::path output_dir{"out"}; ///< relative to the working folder
  std::vector<std::string> formats{"ecsv", "html"};
  bool keeps_inputs = false;       ///< the folder gets copies of them, which its lock names
  bool has_all_csv_digits = false; ///< false: as many as the errors leave
  PolarizationFrame frame = PolarizationFrame::Equatorial;
  std::optional<ScenarioObservation> observation; ///< [observation] and its instrument
  std::map<std::string, Where> places;            ///< where keys stand ("object.0.materials.front")

  /// Where a key stands, else the table that it would stand in, else the file.
  [[nodiscard]] Where place(const std::string &key) const;
};

/// Reads a scenario; each of `overrides` is "dotted.key=value" with a TOML value (a bare word
/// counts as a string). BadInput names file, line and column, what was read, what was expected.
Result<Scenario> read_scenario(const std::filesystem::path &path,
                               const std::vector<std::string> &overrides);
/// The same from a text that stands for the file `path`.
Result<Scenario> read_scenario_text(const std::string &text, const std::filesystem::path &path,
                                    const std::vector<std::string> &overrides);

/// BadInput that lists what a run still needs: observer, time, orbit.
Result<void> check_complete_for_run(const Scenario &scenario);

/// BadInput where a band of [bands] has no zero point in the system of magnitudes: umov observe,
/// which takes bands of its own, asks nothing of them.
Result<void> check_magnitudes(const Scenario &scenario);

/// The scenario as TOML with every default written out and absolute paths; reading it gives the
/// same scenario.
std::string locked_scenario(const Scenario &scenario);

/// A text as TOML has it, with its quotes.
std::string toml_text(const std::string &text);

/// JSON Schema (draft 2020-12) of the scenario, from the same table of keys that the reader checks.
std::string scenario_schema_json();

/// A material by name (paper_* or the library), or from a TOML file with one [material.NAME] table.
Result<Material> read_material(const std::string &name_or_path);
/// The one [material.NAME] table of a text that stands for the file `path`.
Result<Material> read_material_text(const std::string &text, const std::string &path);
/// Names of all compiled-in materials: the paper's six, then the library of data/materials.
std::vector<std::string> material_library();
/// A material as TOML, with the tables of its indices by name, file or in place.
std::string material_as_toml(const Material &material);

/// An object of a scenario with all its files read.
struct LoadedObject {
  std::optional<Trajectory> orbit; ///< absent for a scene
  AttitudeLaw attitude;            ///< complete: tables read, inertia taken from the mesh
  Scene scene;
  std::vector<InputFile> inputs;
};

/// What is tolerated in inputs.
struct LoadOptions {
  bool allow_bad_checksum = false, allow_old_elements = false;
  bool source_is_sun = true; ///< false: a laser, for which a mirror is no matter of the disk
  bool reads_shape = true;   ///< false: the orbit alone; attitude and scene stay empty
  bool turns_in_time = true; ///< false: its attitude is asked for at no time, and needs no epoch
  const std::atomic<bool> *cancel = nullptr; ///< ends the reading where it comes true
  /// The moment that is shown. Within [time] the elements are the span's, chosen and judged by it;
  /// outside they are chosen, and their age is judged, at this moment.
  std::optional<Epoch<Utc>> at = {};
};

/// Reads the files that an object of a scenario names and compiles its scene. Interrupted where
/// LoadOptions::cancel comes true.
Result<LoadedObject> load_object(const Scenario &scenario, std::size_t which,
                                 const LoadOptions &options, Diagnostics &diagnostics);

} // namespace umov
