# One grammar for all modules:
#   umov_module(NAME SOURCES a.cpp ... PUBLIC umov::core ... PRIVATE fmt::fmt ...)
#   umov_tests(NAME SOURCES a_test.cpp ... LABEL unit LIBRARIES umov::optics ...)
#   umov_embed(TARGET SYMBOL FILE): the bytes of FILE in the binary, read with umov/core/embedded.h

option(UMOV_WARNINGS_AS_ERRORS "Treat warnings as errors" OFF)
option(UMOV_SANITIZE "Build with address and undefined-behaviour sanitizers" OFF)

add_library(umov_flags INTERFACE)
target_compile_options(
  umov_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
                       -Wno-restrict # false alarms of g++ 12 on std::string (GCC bug 105651)
                       # Same results for every thread count and build: no silent contraction.
                       -ffp-contract=off $<$<BOOL:${UMOV_WARNINGS_AS_ERRORS}>:-Werror>)
if(UMOV_SANITIZE)
  target_compile_options(umov_flags INTERFACE -fsanitize=address,undefined
                                              -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(umov_flags INTERFACE -fsanitize=address,undefined)
endif()

function(umov_module name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  # Flags, and header-only libraries that no public header includes: needed to build umov, not to
  # use it.
  set(private $<BUILD_INTERFACE:umov_flags>)
  foreach(library IN LISTS arg_PRIVATE)
    if(library MATCHES "^(Boost::boost|Eigen3::Eigen|nlohmann_json::nlohmann_json)$")
      set(library $<BUILD_INTERFACE:${library}>)
    endif()
    list(APPEND private ${library})
  endforeach()
  add_library(umov_${name} STATIC ${arg_SOURCES})
  add_library(umov::${name} ALIAS umov_${name})
  set_target_properties(umov_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY UMOV_MODULES ${name})
  target_compile_features(umov_${name} PUBLIC cxx_std_20)
  target_include_directories(
    umov_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(umov_${name} PUBLIC ${arg_PUBLIC} PRIVATE ${private})
endfunction()

function(umov_tests name)
  if(NOT UMOV_BUILD_TESTS)
    return()
  endif()
  cmake_parse_arguments(arg "" "LABEL" "SOURCES;LIBRARIES" ${ARGN})
  set(target umov_${name}_tests)
  add_executable(${target} ${arg_SOURCES})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE umov_flags ${arg_LIBRARIES} GTest::gtest_main)
  target_compile_definitions(${target} PRIVATE UMOV_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  include(GoogleTest)
  gtest_discover_tests(${target} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60
                       PROPERTIES LABELS ${arg_LABEL})
endfunction()

function(umov_embed target symbol file)
  get_filename_component(path ${file} ABSOLUTE)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${symbol}.S)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
    .section .rodata
    .global umov_embedded_@symbol@_begin
    .global umov_embedded_@symbol@_end
    .balign 16
umov_embedded_@symbol@_begin:
    .incbin "@path@"
umov_embedded_@symbol@_end:
    .byte 0
    .section .note.GNU-stack,"",%progbits
]])
  set_property(SOURCE ${source} APPEND PROPERTY OBJECT_DEPENDS ${path})
  target_sources(${target} PRIVATE ${source})
endfunction()

# umov_embed_folder(TARGET SYMBOL FOLDER SUFFIX): every file of a folder in the binary;
# `const std::vector<EmbeddedFile> &SYMBOL_files()` lists them by stem (umov/core/embedded.h).
function(umov_embed_folder target symbol folder suffix)
  file(GLOB files CONFIGURE_DEPENDS ${folder}/*.${suffix})
  set(declarations "")
  set(entries "")
  set(index 0)
  foreach(path IN LISTS files)
    get_filename_component(stem ${path} NAME_WLE)
    umov_embed(${target} ${symbol}_${index} ${path})
    string(APPEND declarations "UMOV_EMBEDDED(${symbol}_${index})\n")
    string(APPEND entries "      {\"${stem}\", ${symbol}_${index}()},\n")
    math(EXPR index "${index} + 1")
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${symbol}_files.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
#include <umov/core/embedded.h>

namespace umov {
@declarations@
const std::vector<EmbeddedFile> &@symbol@_files() {
  static const std::vector<EmbeddedFile> all{
@entries@  };
  return all;
}
} // namespace umov
]])
  target_sources(${target} PRIVATE ${source})
endfunction()
