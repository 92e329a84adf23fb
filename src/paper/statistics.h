#pragma once
#include <vector>

namespace umov {

/// Value below which a share of the values lies (nearest rank); NaN if there is none.
double quantile(std::vector<double> values, double share);
/// Correlation of ranks (Spearman); ties in order of place. NaN for less than three pairs.
double rank_correlation(const std::vector<double> &a, const std::vector<double> &b);

} // namespace umov
