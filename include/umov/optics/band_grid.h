#pragma once
// The wavelengths at which light is computed, and how those of a band are summed
// (docs/theory/bands.md, Eq. 6 and 7).

#include <umov/optics/band.h>
#include <vector>

namespace umov {

/// Distance of the wavelengths within a band, to begin with, and the least that it is halved to.
inline constexpr double node_step_nm = 10, node_step_min_nm = 2.5;

/// One wavelength's part in a band.
struct BandTerm {
  std::size_t node = 0; ///< into BandGrid::nodes
  double weight = 0;    ///< the weights of a band add up to 1
  double coarse = 0;    ///< the same if every other wavelength were left out
};

/// Eq. 6: what a band has of a quantity that is known at the nodes, and the error that Eq. 7 sees.
template <class Value> struct BandSum {
  Value value{}, change{}; ///< `change`: value minus that of every other wavelength
};
/// `at_node`: the quantity at a node.
template <class Value, class AtNode>
BandSum<Value> sum_band(const std::vector<BandTerm> &terms, const AtNode &at_node) {
  BandSum<Value> out;
  for (const BandTerm &term : terms) {
    const Value value = at_node(term.node);
    out.value += value * term.weight;
    out.change += value * (term.weight - term.coarse);
  }
  return out;
}

/// All wavelengths of a set of bands.
class BandGrid {
public:
  /// `steps_nm`: per band, the distance of its wavelengths; empty: `node_step_nm` for all. BadInput
  /// where the solar spectrum does not cover a curve.
  static Result<BandGrid> make(const std::vector<Band> &bands,
                               const std::vector<double> &steps_nm = {});

  /// Each wavelength once, named after the first band that asks for it. The first one has the
  /// largest weight of the first band: what is told of one wavelength only is told of that.
  [[nodiscard]] const std::vector<Band> &nodes() const { return nodes_; }
  /// Of each band.
  [[nodiscard]] const std::vector<std::vector<BandTerm>> &terms() const { return terms_; }
  /// Every band is one wavelength: nodes and bands are the same.
  [[nodiscard]] bool is_plain() const { return is_plain_; }

private:
  std::vector<Band> nodes_;
  std::vector<std::vector<BandTerm>> terms_;
  bool is_plain_ = true;
};

} // namespace umov
