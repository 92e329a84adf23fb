#pragma once
// Spans of time of tables that consist of segments with `first` and `last`.

#include <string>
#include <umov/time/epoch.h>

namespace umov {

/// A tenth of a millisecond: what dates of six decimals lose on the way through Julian dates.
inline constexpr double span_edge_s = 1e-4;

/// True from `first` to `last` of a segment, edges included.
template <typename Segment> bool covers(const Segment &segment, Epoch<Utc> time) {
  return seconds_between(time, segment.first) >= -span_edge_s &&
         seconds_between(segment.last, time) >= -span_edge_s;
}

/// "FIRST to LAST, FIRST to LAST" of the first four segments, "..." after them, for messages.
template <typename Segments> std::string spans_text(const Segments &segments) {
  std::string out;
  for (std::size_t k = 0; k < segments.size() && k < 4; ++k)
    out += (k > 0 ? ", " : "") + to_iso(segments[k].first) + " to " + to_iso(segments[k].last);
  return segments.size() > 4 ? out + ", ..." : out;
}

} // namespace umov
