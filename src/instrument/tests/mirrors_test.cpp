#include "instrument/tests/anchor.h"

#include <gtest/gtest.h>
#include <umov/instrument/mirrors.h>
#include <umov/instrument/polarimeter.h>

namespace umov {
namespace {

/// Aluminium of data/nk (Rakic 1995), linear between its points, at the wavelengths of the anchors.
std::complex<double> aluminium(double nm) {
  std::ifstream file(UMOV_SOURCE_DIR "/data/nk/Al_Rakic.yml");
  double before[3]{}, now[3]{};
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    double row[3];
    if (!(words >> row[0] >> row[1] >> row[2]))
      continue;
    std::copy(now, now + 3, before);
    std::copy(row, row + 3, now);
    if (now[0] * 1000 >= nm)
      break;
  }
  const double t = (nm / 1000 - before[0]) / (now[0] - before[0]);
  return {before[1] + t * (now[1] - before[1]), before[2] + t * (now[2] - before[2])};
}

const double at_45 = std::sqrt(0.5);

TEST(Mirror, PolarizesAndTurnsLinearIntoCircular) { // nine digits
  for (const int nm : {425, 550, 650}) {
    const auto m = mirror_element(aluminium(nm), at_45).m;
    EXPECT_NEAR(m[1][0] / m[0][0], of("aluminium_q_" + std::to_string(nm)), 1e-9);
    EXPECT_NEAR(m[3][2] / m[0][0], of("aluminium_u_to_v_" + std::to_string(nm)), 1e-9);
    EXPECT_NEAR(std::atan2(m[3][2], m[2][2]) * 180 / pi,
                of("aluminium_retardance_" + std::to_string(nm)), 1e-6);
  }
}

/// HST at 05:12:00Z behind a flat aluminium mirror at 550 nm, over its reflectance: numbers of an
/// independent program in numpy, seven digits.
TEST(Mirror, NasmythPortsOnAPass) {
  const auto m3 = mirror_element(aluminium(550), at_45);
  const Stokes<InstrumentAxes> light{1, .46297522, .18882253, 0};
  struct Case {
    NasmythSide side;
    double expected[4];
  };
  for (const Case &one : {Case{NasmythSide::Right, {1.014392, -.01095226, .5273477, -.03874554}},
                          {NasmythSide::Left, {1.014392, -.3542219, -.3908227, -.03874554}}}) {
    const auto port = nasmyth_port(m3, one.side, Angle::degrees(55.844337));
    const auto s = port * light;
    const double found[] = {s.i, s.q, s.u, s.v};
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(found[k] / m3.m[0][0], one.expected[k], 1e-6) << k;
  }
}

TEST(Mirror, WholeInstrumentAsFieldsGiveIt) { // nine digits
  const auto train = mirror_element(aluminium(550), at_45) * axes_turned(Angle::degrees(25));
  for (const auto &[name, angle] : {std::pair{"chain_o_", 0.}, {"chain_x_", 90.}}) {
    const auto row = first_row(behind(polarizer(300, Angle::degrees(angle)),
                                      retarder(Angle::degrees(183), Angle::degrees(23)) * train));
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(row[k], of(name + std::to_string(k)), 1e-9);
    EXPECT_NEAR(respond(row, Stokes<InstrumentAxes>{1, .2, -.1, .05}),
                of(name + std::string("light")), 1e-9);
  }
}

TEST(Mirror, TwoCrossedOnesCancel) {
  const auto flat = mirror_element(aluminium(550), at_45);
  const auto both = turned(flat, Angle::degrees(90)) * flat;
  EXPECT_NEAR(both.m[1][0] / both.m[0][0], 0, 1e-15);
  EXPECT_NEAR(both.m[3][2] / both.m[0][0], 0, 1e-15);
}

/// Light of a star at an altitude in the south, through a Cassegrain-like primary and secondary and
/// the flat mirror on the altitude axis, its axes carried along.
TEST(TracedBeam, NasmythIsTheClosedRule) {
  const double altitude = 55.844337 * pi / 180;
  const std::complex<double> eta = aluminium(550);
  const Vec3<Enu> to_star{0, -std::cos(altitude), std::sin(altitude)};
  const Vec3<Enu> zenith_side = normalized(Vec3<Enu>{0, 0, 1} - to_star * to_star.z);
  for (const auto &[side, out] : {std::pair{NasmythSide::Right, Vec3<Enu>{-1, 0, 0}},
                                  {NasmythSide::Left, Vec3<Enu>{1, 0, 0}}}) {
    TracedBeam beam(zenith_side, -to_star);
    beam.reflect(to_star, eta); // primary and secondary: normal incidence
    beam.reflect(to_star, eta);
    const double twice = std::pow(mirror_element(eta, 1).m[0][0], 2);
    beam.reflect(normalized(beam.direction() - out), eta);
    EXPECT_NEAR(norm(beam.direction() - out), 0, 1e-15);
    beam.turn_to({0, 0, 1});
    const auto closed = nasmyth_port(mirror_element(eta, at_45), side, Angle::radians(altitude));
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t c = 0; c < 4; ++c) // V keeps its sign: two turns of the field
        EXPECT_NEAR(beam.matrix().m[r][c] / twice, closed.m[r][c], 1e-12) << r << c;
    // The image of the zenith direction stands at +-altitude from the vertical.
    const Vec3<Enu> image = beam.image_of_x();
    EXPECT_NEAR(std::acos(image.z), altitude, 1e-12);
  }
}

using Field = std::array<std::complex<double>, 3>;

Field operator+(const Field &a, const Field &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Field along(Vec3<Enu> v, std::complex<double> amount) {
  return {v.x * amount, v.y * amount, v.z * amount};
}
std::complex<double> part(const Field &e, Vec3<Enu> v) {
  return e[0] * v.x + e[1] * v.y + e[2] * v.z;
}

/// The electric field behind a mirror (Fresnel's amplitudes of a metal, Born & Wolf section 1.5),
/// with no word of Stokes parameters.
Field reflected(const Field &e, Vec3<Enu> k, Vec3<Enu> n, std::complex<double> eta) {
  const double cosine = std::abs(dot(k, n));
  const Vec3<Enu> out = k - n * (2 * dot(k, n));
  const Vec3<Enu> s = normalized(cross(k, out));
  const std::complex<double> root = std::sqrt(eta * eta - (1 - cosine * cosine));
  const std::complex<double> rs = (cosine - root) / (cosine + root);
  const std::complex<double> rp = (eta * eta * cosine - root) / (eta * eta * cosine + root);
  return along(s, rs * part(e, s)) + along(cross(out, s), rp * part(e, cross(k, s)));
}

std::array<double, 4> stokes_of(const Field &e, Vec3<Enu> x, Vec3<Enu> k) {
  const auto a = part(e, x), b = part(e, cross(k, x));
  return {std::norm(a) + std::norm(b), std::norm(a) - std::norm(b), 2 * std::real(std::conj(a) * b),
          2 * std::imag(std::conj(a) * b)};
}

/// O11: a train of seven mirrors, none in the plane of another, on a site that is turned anyhow.
TEST(TracedBeam, SevenMirrorsAsFieldsGiveThem) {
  const std::complex<double> eta = aluminium(550);
  std::array<std::array<double, 16>, 2> found{};
  for (int site = 0; site < 2; ++site) {
    const auto turned_site = [&](Vec3<Enu> v) {
      if (site == 0)
        return v;
      const double a = 1.1, b = -.6; // about the vertical, then about east
      const Vec3<Enu> w{std::cos(a) * v.x - std::sin(a) * v.y,
                        std::sin(a) * v.x + std::cos(a) * v.y, v.z};
      return Vec3<Enu>{w.x, std::cos(b) * w.y - std::sin(b) * w.z,
                       std::sin(b) * w.y + std::cos(b) * w.z};
    };
    const Vec3<Enu> x0 = turned_site({1, 0, 0}), k0 = turned_site({0, 0, -1});
    const Vec3<Enu> last = turned_site(normalized(Vec3<Enu>{.3, .5, -.2}));
    TracedBeam beam(x0, k0);
    // Fields along x, at 45 deg, and turning: with those across they tell every column.
    const Vec3<Enu> y0 = cross(k0, x0);
    const double h = std::sqrt(.5);
    const std::complex<double> i(0, 1);
    std::array<Field, 4> fields{along(x0, 1), along(y0, 1), along(x0, h) + along(y0, h),
                                along(x0, h) + along(y0, h * i)};
    Vec3<Enu> k = k0;
    for (int m = 0; m < 7; ++m) {
      const Vec3<Enu> n =
          turned_site(normalized(Vec3<Enu>{std::sin(1.3 * m), std::cos(2.1 * m), .9}));
      for (Field &field : fields)
        field = reflected(field, k, n, eta);
      beam.reflect(n, eta);
      k = k - n * (2 * dot(k, n));
    }
    beam.turn_to(last);
    const Vec3<Enu> x = normalized(last - k * dot(last, k));
    std::array<std::array<double, 4>, 4> s;
    for (std::size_t f = 0; f < 4; ++f)
      s[f] = stokes_of(fields[f], x, k);
    const auto &m = beam.matrix().m;
    for (std::size_t r = 0; r < 4; ++r) {
      EXPECT_NEAR(m[r][0], (s[0][r] + s[1][r]) / 2, 1e-12) << r;
      EXPECT_NEAR(m[r][1], (s[0][r] - s[1][r]) / 2, 1e-12) << r;
      EXPECT_NEAR(m[r][2], s[2][r] - (s[0][r] + s[1][r]) / 2, 1e-12) << r;
      EXPECT_NEAR(m[r][3], s[3][r] - (s[0][r] + s[1][r]) / 2, 1e-12) << r;
      for (std::size_t c = 0; c < 4; ++c)
        found[static_cast<std::size_t>(site)][4 * r + c] = m[r][c];
    }
  }
  for (std::size_t k = 0; k < 16; ++k)
    EXPECT_NEAR(found[0][k], found[1][k], 1e-12);
}

TEST(TracedBeam, EveryMirrorTurnsCircularLightOver) {
  // The field goes on turning as it did while the light comes back.
  TracedBeam beam({1, 0, 0}, {0, 0, -1});
  beam.reflect({0, 0, 1}, aluminium(550));
  EXPECT_LT(beam.matrix().m[3][3], 0);
  beam.reflect({0, 0, 1}, aluminium(550));
  EXPECT_GT(beam.matrix().m[3][3], 0);
}

/// Light of the named directions by hand, for a telescope that looks towards azimuth 140.5.
TEST(Train, CoudeAsFieldsGiveIt) {
  const double azimuth = 140.5 * pi / 180, altitude = 55.8 * pi / 180;
  const std::complex<double> eta = aluminium(550);
  const Vec3<Enu> forward{std::sin(azimuth), std::cos(azimuth), 0};
  const Vec3<Enu> right{std::cos(azimuth), -std::sin(azimuth), 0}; // at azimuth + 90 deg
  const Vec3<Enu> sky = forward * std::cos(altitude) + Vec3<Enu>{0, 0, std::sin(altitude)};
  const Vec3<Enu> x0 = Vec3<Enu>{0, 0, std::cos(altitude)} - forward * std::sin(altitude);
  Vec3<Enu> k = sky * -1.;
  const Vec3<Enu> y0 = cross(k, x0);
  std::array<Field, 3> fields{along(x0, 1), along(y0, 1),
                              along(x0, std::sqrt(.5)) + along(y0, std::sqrt(.5))};
  // Right along the altitude axis, back through the fork, down the azimuth axis, to a room in the
  // east, and up there.
  for (const Vec3<Enu> &out :
       {right, forward * -1., Vec3<Enu>{0, 0, -1}, Vec3<Enu>{1, 0, 0}, Vec3<Enu>{0, 0, 1}}) {
    for (Field &field : fields)
      field = reflected(field, k, normalized(out - k), eta);
    k = out;
  }
  using enum BeamDirection;
  const MirrorTrain train{{{Right, ""}, {Back, ""}, {Down, ""}, {East, ""}, {Up, ""}}, North};
  const std::vector<std::complex<double>> metals(5, eta);
  const TrainFocus found =
      trace_train(train, metals, Angle::radians(altitude), Angle::radians(azimuth));
  const Vec3<Enu> north{0, 1, 0};
  std::array<std::array<double, 4>, 3> s;
  for (std::size_t f = 0; f < 3; ++f)
    s[f] = stokes_of(fields[f], north, k);
  for (std::size_t r = 0; r < 4; ++r) {
    EXPECT_NEAR(found.matrix.m[r][0], (s[0][r] + s[1][r]) / 2, 1e-12) << r;
    EXPECT_NEAR(found.matrix.m[r][1], (s[0][r] - s[1][r]) / 2, 1e-12) << r;
    EXPECT_NEAR(found.matrix.m[r][2], s[2][r] - (s[0][r] + s[1][r]) / 2, 1e-12) << r;
  }
}

TEST(Train, OneMirrorIsANasmythPort) {
  const std::vector<std::complex<double>> eta{aluminium(425)};
  Telescope named, traced;
  traced.port = TelescopePort::Train;
  for (const auto &[port, side, to] :
       {std::tuple{TelescopePort::NasmythRight, NasmythSide::Right, BeamDirection::Right},
        {TelescopePort::NasmythLeft, NasmythSide::Left, BeamDirection::Left}})
    for (const double altitude : {11., 55.844337, 88.})
      for (const double azimuth : {0., 77., 290.}) {
        const Angle up = Angle::degrees(altitude), towards = Angle::degrees(azimuth);
        named.port = port;
        traced.train = {{{to, ""}}, BeamDirection::Up};
        const auto closed = nasmyth_port(mirror_element(eta[0], at_45), side, up);
        const TrainFocus found = trace_train(traced.train, eta, up, towards);
        for (std::size_t r = 0; r < 4; ++r)
          for (std::size_t c = 0; c < 4; ++c)
            EXPECT_NEAR(found.matrix.m[r][c], closed.m[r][c], 1e-12) << r << c;
        EXPECT_TRUE(is_mirrored(traced));
        EXPECT_NEAR(std::remainder(axis_on_sky(traced, Angle::degrees(30), up, towards).degrees() -
                                       axis_on_sky(named, Angle::degrees(30), up).degrees(),
                                   360),
                    0, 1e-9);
      }
}

/// Behind a perfect train, light along a direction on the sky stands where the axes say.
TEST(Train, AxesAreThoseOfPerfectMirrors) {
  using enum BeamDirection;
  const std::vector<std::complex<double>> perfect(4, {0, 1e9});
  for (const MirrorTrain &train :
       {MirrorTrain{{{Left, ""}, {Down, ""}}, Forward},
        MirrorTrain{{{Right, ""}, {Down, ""}, {South, ""}}, Up},
        MirrorTrain{{{Right, ""}, {Back, ""}, {Down, ""}, {West, ""}}, Up}})
    for (const bool has_derotator : {false, true}) {
      Telescope telescope;
      telescope.port = TelescopePort::Train;
      telescope.train = train;
      telescope.has_derotator = has_derotator;
      const Angle up = Angle::degrees(33), towards = Angle::degrees(250), pa = Angle::degrees(-41);
      const Angle axis = axis_from_zenith(telescope, Angle::degrees(30), pa, up, towards);
      const double on_sky = axis_on_sky(telescope, axis, up, towards).radians();
      if (has_derotator) {
        EXPECT_NEAR(std::remainder(on_sky - (30 + 41) * pi / 180, 2 * pi), 0, 1e-12);
      }
      const Stokes<InstrumentAxes> light{1, std::cos(2 * on_sky), std::sin(2 * on_sky), 0};
      const auto seen =
          axes_turned(axis) *
          (trace_train(train, std::span(perfect).first(train.mirrors.size()), up, towards).matrix *
           light);
      EXPECT_NEAR(seen.q, 1, 1e-6);
      EXPECT_NEAR(seen.u, 0, 1e-6);
    }
}

} // namespace
} // namespace umov
