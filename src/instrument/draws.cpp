#include <umov/instrument/draws.h>

#include <boost/random/gamma_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/poisson_distribution.hpp>
#include <cmath>

namespace umov {

Draws::result_type Draws::operator()() {
  if (left_ == 0) {
    const auto low = static_cast<std::uint32_t>(key_.seed);
    const auto high = static_cast<std::uint32_t>(key_.seed >> 32);
    // 10 bits tell apart up to 1023 objects; the rest of the word is the channel's.
    words_ = philox({block_++, key_.exposure, key_.channel ^ (key_.object << 22), key_.pixel},
                    {low, high ^ 0x6f627376u}); // "obsv": apart from other uses of the seed
    left_ = 4;
  }
  return words_[--left_];
}

double Draws::poisson(double mean) {
  if (!(mean > 0))
    return 0;
  constexpr double largest = 1e9; // beyond it a whole number tells no more than a normal one
  if (mean > largest)
    return mean + std::sqrt(mean) * normal();
  return static_cast<double>(boost::random::poisson_distribution<std::int64_t>(mean)(*this));
}

double Draws::normal() { return boost::random::normal_distribution<double>()(*this); }

double Draws::gamma(double shape) {
  return boost::random::gamma_distribution<double>(shape)(*this);
}

} // namespace umov
