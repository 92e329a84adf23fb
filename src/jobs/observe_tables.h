#pragma once
// Private: the tables of an observation, filled exposure by exposure.

#include "jobs/observe_exposure.h"

#include <array>
#include <umov/io/table.h>

namespace umov::jobs {

/// What the rows of both tables begin with.
class ExposureColumns {
public:
  void add(const Setup &setup, const Exposure &exposure, const Epoch<Utc> &time,
           std::size_t slice = 0);
  void put(Table &table) &&;

private:
  std::vector<std::string> time_, name_, band_;
  std::vector<std::int64_t> exposure_, set_;
};

/// A row for each channel of an exposure, or of a piece of its trail.
class CountsTable {
public:
  explicit CountsTable(const Setup &setup) : s_(setup) {}
  void add(const Exposure &exposure, const Recorded &recorded);
  [[nodiscard]] Table table() &&;

private:
  void add(const Exposure &exposure, const Recorded &recorded,
           const std::vector<ChannelCounts> &channels, double offset_s, std::size_t slice);
  const Setup &s_;
  ExposureColumns exposures_;
  std::vector<std::string> channel_;
  std::vector<bool> saturated_;
  std::array<std::vector<double>, 22> numbers_;
};

/// A row for each exposure or piece: what was there to be seen.
class TruthTable {
public:
  explicit TruthTable(const Setup &setup) : s_(setup) {}
  void add(const Exposure &exposure, const Recorded &recorded);
  [[nodiscard]] Table table() &&;

private:
  void add(const Exposure &exposure, const Recorded &recorded, const RecordedSlice &slice,
           std::size_t number);
  const Setup &s_;
  ExposureColumns exposures_;
  std::array<std::vector<double>, 10> numbers_;
};

/// What a header says of the observation.
void note_observation(Table &table, const Scenario &scenario, const ObservedBands &bands);

} // namespace umov::jobs
