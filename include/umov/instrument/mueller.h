#pragma once
// Elements of a polarimeter as Mueller matrices, with the field directions of docs/conventions.md.

#include <array>
#include <umov/optics/stokes.h>

namespace umov {

/// +Q along the instrument's x axis; angles from it, counter-clockwise as seen by someone who looks
/// against the light.
struct InstrumentAxes {};
/// Takes light in those axes to light in those axes.
using InstrumentMueller = Mueller<InstrumentAxes, InstrumentAxes>;

/// What a detector behind a train of elements makes of the light: counts = row . (I, Q, U, V).
using StokesRow = std::array<double, 4>;

/// Nothing.
InstrumentMueller identity_element();
/// The same light in axes turned by `angle`.
InstrumentMueller axes_turned(Angle angle);
/// An element whose own axes stand at `angle`.
InstrumentMueller turned(const InstrumentMueller &element, Angle angle);
/// One behind the other: light meets `first` first.
InstrumentMueller behind(const InstrumentMueller &second, const InstrumentMueller &first);

/// Transmittances along the element's x and y, and the phase of y minus the phase of x in
/// exp(-i omega t): x is the fast axis where it is positive.
InstrumentMueller diattenuating_retarder(double tx, double ty, Angle retardance);
/// Linear polarizer at an angle; extinction: transmittance along its axis, 1, over that across it.
InstrumentMueller polarizer(double extinction, Angle angle);
/// Retarder with its x axis at an angle.
InstrumentMueller retarder(Angle retardance, Angle angle);
/// Weak polarization by the instrument itself: adds q0 I and u0 I.
InstrumentMueller instrumental_polarization(double q0, double u0);

/// First row of a matrix: what a detector that knows no polarization sees.
StokesRow first_row(const InstrumentMueller &train);
/// The row in front of which an element was put.
StokesRow operator*(const StokesRow &row, const InstrumentMueller &element);
/// A row in sky axes, from one in axes that stand at `angle` in that sky.
StokesRow row_on_sky(const StokesRow &row, Angle angle);
/// Sums and multiples of rows.
StokesRow operator+(const StokesRow &a, const StokesRow &b);
/// As above.
StokesRow operator*(const StokesRow &a, double factor);
/// Counts that a row makes of light.
template <class Basis> double respond(const StokesRow &row, const Stokes<Basis> &s) {
  return row[0] * s.i + row[1] * s.q + row[2] * s.u + row[3] * s.v;
}

} // namespace umov
