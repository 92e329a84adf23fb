// The light of one object in one pose: a gold cube, lit along x and seen at 60 deg from the Sun.
#include <cstdio>
#include <umov/umov.h>

umov::Result<void> print_stokes() {
  UMOV_ASSIGN(gold, umov::builtin_material("paper_au"));
  UMOV_ASSIGN(bands, umov::bands_from({"nm:550"}));
  umov::Diagnostics warnings;
  UMOV_ASSIGN(scene, umov::make_scene(umov::make_chamfered_cube(1.0, 0.1), umov::NormalMode::Flat,
                                      bands, {gold}, {gold}, warnings));
  UMOV_ASSIGN(light, umov::make_light(scene, {}, {}));

  const double phase = umov::Angle::degrees(60).radians();
  const umov::Pose pose{
      {1, 0, 0}, {std::cos(phase), std::sin(phase), 0}, umov::sun_radius_at_1au_rad};
  umov::StokesTable table;
  if (!light->evaluate(std::span(&pose, 1), table))
    return umov::fail(umov::ErrorCode::Interrupted, "stopped");
  const umov::BandResult result = table.at(0, 0);
  std::printf("I %.6g +- %.1g m2/sr, Q/I %.4f, U/I %.4f\n", result.stokes.i, result.half_width.i,
              result.stokes.q / result.stokes.i, result.stokes.u / result.stokes.i);
  return {};
}

int main() {
  const auto done = print_stokes();
  if (!done)
    std::fprintf(stderr, "%s\n", done.error().text().c_str());
  return done ? 0 : static_cast<int>(done.error().code);
}
