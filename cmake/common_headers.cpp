// The target of precompiled headers needs a source.
#include <algorithm>
