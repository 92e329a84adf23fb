#include <umov/instrument/mueller.h>

#include <cmath>

namespace umov {

InstrumentMueller identity_element() { return axes_turned(Angle()); }

InstrumentMueller axes_turned(Angle angle) {
  const double c = std::cos(2 * angle.radians()), s = std::sin(2 * angle.radians());
  return {{{{1, 0, 0, 0}, {0, c, s, 0}, {0, -s, c, 0}, {0, 0, 0, 1}}}};
}

InstrumentMueller turned(const InstrumentMueller &element, Angle angle) {
  return axes_turned(Angle::radians(-angle.radians())) * element * axes_turned(angle);
}

InstrumentMueller behind(const InstrumentMueller &second, const InstrumentMueller &first) {
  return second * first;
}

InstrumentMueller diattenuating_retarder(double tx, double ty, Angle retardance) {
  const double a = (tx + ty) / 2, b = (tx - ty) / 2, c = std::sqrt(tx * ty);
  const double cosine = c * std::cos(retardance.radians());
  const double sine = c * std::sin(retardance.radians());
  return {{{{a, b, 0, 0}, {b, a, 0, 0}, {0, 0, cosine, -sine}, {0, 0, sine, cosine}}}};
}

InstrumentMueller polarizer(double extinction, Angle angle) {
  return turned(diattenuating_retarder(1, 1 / extinction, Angle()), angle);
}

InstrumentMueller retarder(Angle retardance, Angle angle) {
  return turned(diattenuating_retarder(1, 1, retardance), angle);
}

InstrumentMueller instrumental_polarization(double q0, double u0) {
  InstrumentMueller out = identity_element();
  out.m[1][0] = q0;
  out.m[2][0] = u0;
  return out;
}

StokesRow first_row(const InstrumentMueller &train) { return train.m[0]; }

StokesRow operator*(const StokesRow &row, const InstrumentMueller &element) {
  StokesRow out{};
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t k = 0; k < 4; ++k)
      out[c] += row[k] * element.m[k][c];
  return out;
}

StokesRow row_on_sky(const StokesRow &row, Angle angle) { return row * axes_turned(angle); }

StokesRow operator+(const StokesRow &a, const StokesRow &b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]};
}

StokesRow operator*(const StokesRow &a, double factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor, a[3] * factor};
}

} // namespace umov
