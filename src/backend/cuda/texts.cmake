# The texts that are compiled for a card when one is first used: the program, everything that it
# includes, and stand-ins for the few standard headers that the compiler of cards does not have.
# tests/ptx_test.cpp compiles exactly these.
set(texts
    backend/cuda/program.cu=src/backend/cuda/program.cu
    cmath=src/backend/cuda/headers/cmath.h
    cstddef=src/backend/cuda/headers/cstddef.h
    cstdint=src/backend/cuda/headers/cstdint.h
    numbers=src/backend/cuda/headers/numbers.h
    type_traits=src/backend/cuda/headers/type_traits.h
    umov/core/vec3.h=include/umov/core/vec3.h
    umov/kernel/lobe.h=include/umov/kernel/lobe.h)
foreach(header IN ITEMS
        backend/colours.h backend/cuda/card_poses.h backend/cuda/running_sum.h backend/cuda/thread_machine.h
        backend/curved_classes.inl.h backend/facet_loops.inl.h backend/lit_facets.inl.h backend/mask_look.inl.h backend/octahedron.h
        backend/one_facet_machine.h
        backend/pose_constants.h backend/scene_data.h backend/view.h kernel/angles.inl.h kernel/begin.h
        kernel/body.inl.h kernel/disk_lobe.h kernel/disk_lobe.inl.h kernel/end.h kernel/facet.inl.h
        kernel/facet_constants.h kernel/math.inl.h kernel/microfacet.inl.h kernel/qualifier.h
        kernel/solar_nodes.inl.h)
  list(APPEND texts ${header}=src/${header})
endforeach()
set(declarations "")
set(entries "")
set(index 0)
foreach(text IN LISTS texts)
  string(REPLACE "=" ";" pair ${text})
  list(GET pair 0 name)
  list(GET pair 1 file)
  umov_embed(umov_backend card_text_${index} ${PROJECT_SOURCE_DIR}/${file})
  string(APPEND declarations "UMOV_EMBEDDED(card_text_${index})\n")
  string(APPEND entries "      {\"${name}\", card_text_${index}()},\n")
  math(EXPR index "${index} + 1")
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/card_texts.cpp @ONLY CONTENT [[
#include "backend/cuda/compiler.h"

#include <umov/core/embedded.h>

@declarations@
namespace umov::backend {
const std::vector<CardText> &card_texts() {
  static const std::vector<CardText> all{
@entries@  };
  return all;
}
} // namespace umov::backend
]])
target_sources(umov_backend PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/card_texts.cpp)
