#pragma once
#include <array>

namespace umov {

/// Counts of the two beams behind a half-wave plate.
struct BeamPair {
  double ordinary = 0, extraordinary = 0;
};

/// q (plates at 0 and 45 deg) or u (22.5 and 67.5) times the analyser's diattenuation: exact under
/// unequal beams and changing transparency.
double ratio_method(const BeamPair &first, const BeamPair &second);
/// The same by half the difference of the two contrasts: wrong by the square of the beams' gain
/// mismatch.
double double_difference(const BeamPair &first, const BeamPair &second);
/// Two parameters from eight plate positions (0 to 157.5 deg) and the two differences that should
/// be 0: what repeats after half a turn of the plate.
struct EightPositions {
  double q = 0, u = 0, null_q = 0, null_u = 0;
};
/// By the ratio method; beams in the order of the plate's angles.
EightPositions eight_positions(const std::array<BeamPair, 8> &beams);

} // namespace umov
