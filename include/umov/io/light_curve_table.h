#pragma once
// Light curves and their passes as tables.

#include <umov/io/table.h>
#include <umov/lightcurve/compute.h>

namespace umov {

/// The columns of a light curve, one row per epoch and band, and the 95 % half-widths.
Table light_curve_table(const LightCurve &curve, PolarizationFrame frame);
/// One row per pass: rise, culmination, set, number of epochs kept.
Table passes_table(const std::vector<Pass> &passes, const LightCurve &curve);

/// Tells in the header what the curves among the bands are and how they were summed; nothing where
/// every band is one wavelength.
void note_curves(const std::vector<Band> &bands, Table &table);

} // namespace umov
