#pragma once
// Private: what sets and series of counts have in common.

#include "jobs/reduced.h"

#include <span>
#include <string>
#include <umov/core/diagnostics.h>
#include <vector>

namespace umov::jobs {

using Rows = std::span<const CountRow>;

/// A row's datum, its row behind the instrument's own terms if they are known.
ChannelDatum datum_of(const CountRow &row, const ReduceOptions &options);
std::vector<ChannelDatum> data_of(Rows rows, const ReduceOptions &options);

/// A row's datum with the light that a model has at its time, for errors that rows share.
ModelledDatum modelled(const CountRow &row, const ChannelDatum &datum,
                       const std::array<double, 4> &stokes, std::size_t gain);

/// Channels of one name share a gain; without names each has its own.
std::vector<std::size_t> gains_of(Rows rows);

/// What a row of the result tells of where the light came from: of the middle of its exposures.
CountRow middle_of(Rows rows);

void add_flag(std::string &flags, const char *flag);

/// Flags of a result that was found: fits that noise does not explain, and more polarized light
/// than light.
void judge(Reduced &r, const ReduceOptions &options);

/// Gaps within what is reduced together: brightness may have changed unseen.
void warn_of_gaps(const std::vector<CountRow> &rows, bool is_series, Diagnostics &diagnostics);

tl::unexpected<Error> all_saturated();

} // namespace umov::jobs
