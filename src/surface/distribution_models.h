#pragma once
// Private: the models that the files of src/surface/distributions define. A file NAME.cpp defines
// `const DistributionModel &distribution_NAME()`; the build writes the list from the file names.

#include <umov/surface/distribution.h>

namespace umov {

std::vector<const DistributionModel *> list_distribution_models();

} // namespace umov
