# umov::umov, all of the library at once, and what others need to find it: headers, archives, the
# CMake package, umov.pc, licence, man page and examples.
get_property(modules GLOBAL PROPERTY UMOV_MODULES) # lowest first
set(product paper) # made with the library, no part of it
list(REMOVE_ITEM modules ${product})

add_library(umov_all INTERFACE)
add_library(umov::umov ALIAS umov_all)
set_target_properties(umov_all PROPERTIES EXPORT_NAME umov)
list(TRANSFORM modules PREPEND umov:: OUTPUT_VARIABLE targets)
target_link_libraries(umov_all INTERFACE ${targets})

if(NOT UMOV_INSTALL)
  return()
endif()

include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/umov)
set(documents ${CMAKE_INSTALL_DOCDIR})

list(TRANSFORM modules PREPEND umov_ OUTPUT_VARIABLE archives)
install(TARGETS umov_all ${archives} EXPORT umovTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT umovTargets NAMESPACE umov:: DESTINATION ${package})
install(DIRECTORY include/umov DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h"
        PATTERN paper EXCLUDE)
configure_package_config_file(cmake/umovConfig.cmake.in ${PROJECT_BINARY_DIR}/umovConfig.cmake
                              INSTALL_DESTINATION ${package})
# Before 1.0 a minor version may break its users.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/umovConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/umovConfig.cmake ${PROJECT_BINARY_DIR}/umovConfigVersion.cmake
        DESTINATION ${package})

# An archive stands before those that it needs.
list(REVERSE modules)
list(TRANSFORM modules PREPEND -lumov_ OUTPUT_VARIABLE pc_libraries)
list(JOIN pc_libraries " " pc_libraries)
set(pc_requires "fmt erfa libhwy assimp tomlplusplus yaml-cpp pugixml libcrypto")
if(UMOV_WITH_REPORT)
  string(APPEND pc_requires " libpng zlib")
endif()
if(UMOV_WITH_FITS)
  string(APPEND pc_requires " cfitsio")
endif()
if(UMOV_WITH_EXR)
  string(APPEND pc_requires " OpenEXR")
endif()
set(pc_prefix ${CMAKE_INSTALL_PREFIX})
if(NOT IS_ABSOLUTE ${CMAKE_INSTALL_LIBDIR})
  file(RELATIVE_PATH pc_up /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
  set(pc_prefix "\${pcfiledir}/${pc_up}")
endif()
configure_file(cmake/umov.pc.in ${PROJECT_BINARY_DIR}/umov.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/umov.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(FILES LICENSE THIRD_PARTY.md README.md CHANGELOG.md docs/conventions.md
        data/solar/LICENSE-sbpy.txt DESTINATION ${documents})
install(DIRECTORY LICENSES DESTINATION ${documents})
install(DIRECTORY examples DESTINATION ${documents})
# What the scenarios of examples read.
install(DIRECTORY data/tle data/mesh DESTINATION ${documents}/data)
if(UMOV_WITH_CLI)
  # From the same source as --help.
  install(CODE "
    set(place \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1\")
    file(MAKE_DIRECTORY \"\${place}\")
    execute_process(COMMAND $<TARGET_FILE:umov> man -o \"\${place}/umov.1\"
                    COMMAND_ERROR_IS_FATAL ANY)")
endif()
