#pragma once
// One function per claim of the paper's text.

#include "paper/workshop.h"

namespace umov {

/// Q of one material is the same for every shape and pose.
Result<PaperFigure> make_claim_shape(PaperWorkshop &);
/// Two materials: a straight line between two points.
Result<PaperFigure> make_claim_locus(PaperWorkshop &);
/// Clouds are planes, for the reason given, and turn slowly with phase angle.
Result<PaperFigure> make_claim_plane(PaperWorkshop &);
/// Points off the plane are faint.
Result<PaperFigure> make_claim_faint(PaperWorkshop &);
/// HST and Agena do not overlap.
Result<PaperFigure> make_claim_separation(PaperWorkshop &);
/// Passes stay on a plane because satellites point steadily.
Result<PaperFigure> make_claim_passes(PaperWorkshop &);
/// Roll about the line of sight leaves Q unchanged.
Result<PaperFigure> make_claim_roll(PaperWorkshop &);
/// I and Q are complementary in their spectral variance.
Result<PaperFigure> make_claim_spectral(PaperWorkshop &);
/// BK7 and Mylar are told apart by total reflectivity.
Result<PaperFigure> make_claim_reflectivity(PaperWorkshop &);
/// Incidence is above 20 degrees in LEO and for most of GEO.
Result<PaperFigure> make_claim_incidence(PaperWorkshop &);
/// Polarization is unaffected by the atmosphere.
Result<PaperFigure> make_claim_atmosphere(PaperWorkshop &);
/// Multiple scattering is negligible.
Result<PaperFigure> make_claim_multiple(PaperWorkshop &);

} // namespace umov
