# SPDX-License-Identifier: Apache-2.0
# cmake --install: the OpenCL half as Kilolux::kilolux and by pkg-config, and the program if there is one.
include(CMakePackageConfigHelpers)

# The rooms of the OpenCL half in one archive.
add_library(kilolux_cl STATIC $<TARGET_OBJECTS:kilolux_base> $<TARGET_OBJECTS:kilolux_gpu>
  $<TARGET_OBJECTS:kilolux_lighting>)
add_library(Kilolux::kilolux ALIAS kilolux_cl)
set_target_properties(kilolux_cl PROPERTIES EXPORT_NAME kilolux OUTPUT_NAME kilolux)
target_compile_features(kilolux_cl PUBLIC cxx_std_20)
target_link_libraries(kilolux_cl PUBLIC PkgConfig::OPENCL Threads::Threads)
get_target_property(definitions kilolux_gpu INTERFACE_COMPILE_DEFINITIONS)
target_compile_definitions(kilolux_cl INTERFACE ${definitions})
# Headers as others see them: public_headers.cmake.
target_include_directories(kilolux_cl PUBLIC $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
install(TARGETS kilolux_cl EXPORT KiloluxTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  COMPONENT development)
install(CODE "execute_process(COMMAND \"${CMAKE_COMMAND}\" \"-DROOT=${CMAKE_SOURCE_DIR}\"
  \"-DDESTINATION=\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/kilolux\"
  \"-DROOMS=host/base|host/gpu|host/stages|host/lighting|kernels/shared\"
  -P \"${CMAKE_SOURCE_DIR}/host/install/public_headers.cmake\" COMMAND_ERROR_IS_FATAL ANY)" COMPONENT development)

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Kilolux)
configure_package_config_file(host/install/KiloluxConfig.cmake.in ${CMAKE_BINARY_DIR}/KiloluxConfig.cmake
  INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/KiloluxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/KiloluxConfig.cmake ${CMAKE_BINARY_DIR}/KiloluxConfigVersion.cmake
  DESTINATION ${config_folder} COMPONENT development)
install(EXPORT KiloluxTargets NAMESPACE Kilolux:: DESTINATION ${config_folder} COMPONENT development)

# Relative to its own place, so that a prefix may be moved.
file(RELATIVE_PATH PC_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
list(TRANSFORM definitions PREPEND -D)
list(JOIN definitions " " PC_DEFINITIONS)
foreach(name kilolux kilolux-c)
  configure_file(host/install/${name}.pc.in ${CMAKE_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${CMAKE_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endforeach()

if(KILOLUX_PROGRAM)
  install(TARGETS kilolux RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
  install(TARGETS kilolux_images_module LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/kilolux COMPONENT program)
endif()
