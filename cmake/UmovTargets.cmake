# One grammar for all modules:
#   umov_module(NAME SOURCES a.cpp ... PUBLIC umov::core ... PRIVATE fmt::fmt ...)
#   umov_tests(NAME SOURCES a_test.cpp ... LABEL unit LIBRARIES umov::optics ... LONG Suite.Test ...)
#   umov_fuzz_target(NAME LIBRARIES umov::io_mesh ... SEEDS data/mesh ...)
#   umov_embed(TARGET SYMBOL FILE): the bytes of FILE in the binary, read with umov/core/embedded.h

option(UMOV_WARNINGS "Warn; who only builds it (tools/build) compiles a seventh faster without" ON)
option(UMOV_WARNINGS_AS_ERRORS "Treat warnings as errors" OFF)
set(UMOV_SANITIZE "" CACHE STRING "address (with undefined behaviour) or thread; empty: none")
set(UMOV_SANITIZE_MODULES "" CACHE STRING
    "Only these modules with the sanitizer, all others as fast as they compile; empty: all of them")
option(UMOV_QUICK_TO_COMPILE "Release: common headers precompiled, sources joined (of sanitize-gate, too), and -O1 where nothing is computed" ON)
option(UMOV_FOR_THIS_MACHINE "Light's loops for this machine's instruction set and a slow one for all others" OFF)
option(UMOV_FUZZ "Build tests/fuzz as fuzzers (clang): libFuzzer, coverage of the readers" OFF)

# umov_plain: without sanitizers, for modules that need none.
add_library(umov_plain INTERFACE)
add_library(umov_flags INTERFACE)
foreach(flags IN ITEMS umov_plain umov_flags)
  target_compile_options(
    ${flags} INTERFACE # Same results for every thread count and build: no silent contraction.
                       -ffp-contract=off $<$<BOOL:${UMOV_WARNINGS_AS_ERRORS}>:-Werror>)
  if(UMOV_WARNINGS)
    target_compile_options(
      ${flags} INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion
                         # false alarms of g++ 12 on std::string (GCC bug 105651)
                         $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict>)
  else()
    target_compile_options(${flags} INTERFACE -w)
  endif()
  if(UMOV_QUICK_TO_COMPILE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # The compiler's memory is first searched for garbage at 512 MB, not at 128: an eighth of the time of large sources.
    target_compile_options(${flags} INTERFACE --param=ggc-min-heapsize=524288)
  endif()
endforeach()
if(UMOV_SANITIZE)
  string(REGEX REPLACE "^address$" "address,undefined" sanitizers ${UMOV_SANITIZE})
  target_compile_options(umov_flags INTERFACE -fsanitize=${sanitizers} -fno-sanitize-recover=all
                                              -fno-omit-frame-pointer)
  target_link_options(umov_flags INTERFACE -fsanitize=${sanitizers})
endif()
if(UMOV_FUZZ)
  target_compile_options(umov_flags INTERFACE -fsanitize=fuzzer-no-link -fprofile-instr-generate
                                              -fcoverage-mapping)
  target_link_options(umov_flags INTERFACE -fprofile-instr-generate)
endif()

# A release reads the headers that nearly all sources include once: half a second less for each of three
# hundred files, a second for each of two hundred tests. Other builds include what they say, so that
# nothing is forgotten.
add_library(umov_common_headers STATIC ${CMAKE_CURRENT_LIST_DIR}/common_headers.cpp)
target_link_libraries(umov_common_headers PRIVATE umov_flags fmt::fmt tl::expected)
if(UMOV_QUICK_TO_COMPILE AND CMAKE_BUILD_TYPE STREQUAL Release AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_precompile_headers(umov_common_headers PRIVATE ${CMAKE_CURRENT_LIST_DIR}/common_headers.h)
  set(UMOV_COMMON_HEADERS ON)
  if(UMOV_BUILD_TESTS)
    # A program, as tests are: code of libraries stands elsewhere.
    add_executable(umov_test_headers EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/common_headers.cpp)
    target_compile_features(umov_test_headers PRIVATE cxx_std_20)
    target_link_libraries(umov_test_headers PRIVATE umov_flags fmt::fmt tl::expected GTest::gtest_main)
    target_precompile_headers(umov_test_headers PRIVATE ${CMAKE_CURRENT_LIST_DIR}/test_headers.h)
  endif()
endif()

# umov_quick_to_compile(TARGET ...): what reads, writes and says things, where -O3 makes for long compiling and for
# nothing else; the light itself is not in it.
function(umov_quick_to_compile)
  foreach(target IN LISTS ARGN)
    if(TARGET ${target} AND UMOV_QUICK_TO_COMPILE AND CMAKE_BUILD_TYPE STREQUAL Release)
      target_compile_options(${target} PRIVATE -O1)
    endif()
  endforeach()
endfunction()

# umov_in_pieces(FILES TARGET ...): so many sources as one, where each spends its time on instantiating what the others do
# too (CLI11, Eigen, GoogleTest). Builds of which nothing is asked in a hurry (dev, all of sanitize) compile them one by one, so that
# every file keeps its own includes.
function(umov_in_pieces files)
  foreach(target IN LISTS ARGN)
    if(TARGET ${target} AND UMOV_QUICK_TO_COMPILE AND (UMOV_SANITIZE_MODULES OR CMAKE_BUILD_TYPE STREQUAL Release))
      set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
    endif()
  endforeach()
endfunction()

# umov_for_this_machine(TARGET): Highway's loops of a target that wants AVX3_DL are compiled six times, once for each instruction
# set; where only this machine counts, for the one that it takes and for the slowest, so that the program runs anywhere.
function(umov_for_this_machine target)
  if(NOT UMOV_FOR_THIS_MACHINE OR CMAKE_CROSSCOMPILING)
    return()
  endif()
  try_run(ran compiled SOURCE_FROM_CONTENT left_out.cpp [[
#define HWY_WANT_AVX3_DL
#include <cstdio>
#include <hwy/targets.h>
int main() {
  const long long can = hwy::SupportedTargets() & HWY_TARGETS;
  std::printf("%lld", static_cast<long long>(HWY_TARGETS & ~(can & -can) & ~HWY_STATIC_TARGET));
}
]] NO_CACHE LINK_LIBRARIES PkgConfig::HWY RUN_OUTPUT_VARIABLE left_out)
  if(compiled AND ran EQUAL 0)
    target_compile_definitions(${target} PRIVATE HWY_DISABLED_TARGETS=${left_out}LL)
  endif()
endfunction()

function(umov_module name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  # Flags, and header-only libraries that no public header includes: needed to build umov, not to
  # use it.
  set(private $<BUILD_INTERFACE:umov_flags>)
  if(UMOV_SANITIZE_MODULES AND NOT name IN_LIST UMOV_SANITIZE_MODULES)
    set(private $<BUILD_INTERFACE:umov_plain>)
    set(quick_options -O0)
  endif()
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
  target_compile_options(umov_${name} PRIVATE ${quick_options})
  target_include_directories(
    umov_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(umov_${name} PUBLIC ${arg_PUBLIC} PRIVATE ${private})
  # Those with fmt: a definition of its target must be the same here and there.
  if(UMOV_COMMON_HEADERS AND "fmt::fmt" IN_LIST arg_PRIVATE)
    target_precompile_headers(umov_${name} REUSE_FROM umov_common_headers)
  endif()
endfunction()

# umov_tests(NAME LABEL ... SOURCES ... LIBRARIES ...): a program of tests. SLOW: those of half of its time, which a first
# build leaves to `./test --gates`; LONG: those that `./test --all` asks alone.
function(umov_tests name)
  if(NOT UMOV_BUILD_TESTS)
    return()
  endif()
  cmake_parse_arguments(arg "" "LABEL" "SOURCES;LIBRARIES;SLOW;LONG" ${ARGN})
  set(target umov_${name}_tests)
  add_executable(${target} ${arg_SOURCES})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${target} PRIVATE umov_flags ${arg_LIBRARIES} GTest::gtest_main)
  if(UMOV_COMMON_HEADERS) # definitions of fmt's target must be the same here and there
    target_link_libraries(${target} PRIVATE fmt::fmt tl::expected)
    target_precompile_headers(${target} REUSE_FROM umov_test_headers)
  endif()
  target_compile_definitions(${target} PRIVATE UMOV_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                               $<$<BOOL:${UMOV_SANITIZE}>:UMOV_SANITIZED>)
  umov_in_pieces(4 ${target})
  include(GoogleTest)
  set(others "")
  foreach(label IN ITEMS SLOW LONG)
    list(JOIN arg_${label} ":" named)
    if(named)
      string(TOLOWER ${label} lower)
      gtest_discover_tests(${target} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60 TEST_FILTER ${named}
                           TEST_LIST ${target}_${label} PROPERTIES LABELS ${lower})
      list(APPEND others ${named})
    endif()
  endforeach()
  if(others)
    list(JOIN others ":" others)
    set(others TEST_FILTER -${others})
  endif()
  gtest_discover_tests(${target} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60 ${others}
                       PROPERTIES LABELS ${arg_LABEL})
  if(arg_LABEL STREQUAL "long") # built for `./test --all` alone
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL ON)
    if(NOT TARGET umov_long_tests)
      add_custom_target(umov_long_tests)
    endif()
    add_dependencies(umov_long_tests ${target})
  endif()
endfunction()

# tests/fuzz/NAME.cpp: a fuzzer with UMOV_FUZZ, else a program that runs over the files named. Its test
# replays the corpus and the further SEEDS (files or folders of the project). READS: the sources
# whose coverage tools/fuzz tells; DICTIONARY: of tests/fuzz/dictionaries.
function(umov_fuzz_target name)
  cmake_parse_arguments(arg "" "DICTIONARY" "LIBRARIES;SEEDS;READS" ${ARGN})
  set(target fuzz_${name})
  add_executable(${target} ${name}.cpp)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${target} PRIVATE umov_flags ${arg_LIBRARIES} fmt::fmt)
  set(seeds ${CMAKE_CURRENT_SOURCE_DIR}/corpus/${name})
  foreach(seed IN LISTS arg_SEEDS)
    list(APPEND seeds ${PROJECT_SOURCE_DIR}/${seed})
  endforeach()
  set_property(GLOBAL APPEND PROPERTY UMOV_FUZZ_TARGETS ${target})
  list(JOIN seeds " " seed_words)
  list(JOIN arg_READS " " read_words)
  set_property(GLOBAL APPEND_STRING PROPERTY UMOV_FUZZ_LIST
               "${name}|${arg_DICTIONARY}|${seed_words}|${read_words}\n")
  if(UMOV_FUZZ)
    target_link_options(${target} PRIVATE -fsanitize=fuzzer)
  else()
    if(NOT TARGET umov_fuzz_replay)
      add_library(umov_fuzz_replay OBJECT replay.cpp)
      target_include_directories(umov_fuzz_replay PRIVATE ${PROJECT_SOURCE_DIR}/tests)
      target_link_libraries(umov_fuzz_replay PRIVATE umov_flags umov::core)
    endif()
    target_link_libraries(${target} PRIVATE umov_fuzz_replay umov::core)
    add_test(NAME corpus.${name} COMMAND ${target} ${seeds})
    set_tests_properties(corpus.${name} PROPERTIES LABELS corpus)
  endif()
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
