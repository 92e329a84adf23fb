#include "backend/scene_data.h"

#include <umov/light/instruction_set.h>
#include <utility>

namespace umov {

const char *engine_instruction_set() { return backend::instruction_set_name(); }

bool restrict_engine(std::string_view instruction_set) {
  using backend::InstructionSet;
  constexpr std::pair<std::string_view, InstructionSet> names[] = {
      {"best", InstructionSet::Best},
      {"avx512", InstructionSet::Avx512},
      {"avx2", InstructionSet::Avx2},
      {"sse4", InstructionSet::Sse4},
      {"baseline", InstructionSet::Baseline}};
  for (const auto &[name, set] : names)
    if (name == instruction_set)
      return backend::choose_instruction_set(set);
  return false;
}

} // namespace umov
