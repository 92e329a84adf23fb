#pragma once
// What a caller of a public function must have seen to.

#include <cstdio>
#include <cstdlib>

/// Ends the program, saying where, if what a function asks of its caller does not hold: to go on
/// would read what is not there.
#define UMOV_EXPECTS(condition)                                                                    \
  do {                                                                                             \
    if (!(condition)) {                                                                            \
      std::fprintf(stderr, "%s:%d: %s: expected of the caller: %s\n", __FILE__, __LINE__,          \
                   __func__, #condition);                                                          \
      std::abort();                                                                                \
    }                                                                                              \
  } while (false)
