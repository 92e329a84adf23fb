// Of <numbers>, for the compiler of cards at run time.
#pragma once
namespace std::numbers {
inline constexpr double pi = 3.141592653589793, log2e = 1.4426950408889634;
}
