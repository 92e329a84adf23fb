// Included before the sources of a release's tests, precompiled: what nearly all of them read
// (UmovTargets.cmake).
#include "common_headers.h"

#include <fstream>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <sstream>
