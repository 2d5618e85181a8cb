# SPDX-License-Identifier: Apache-2.0
# Installs the library alone into a prefix, and builds and runs host/example and a C program against
# it, by CMake and by pkg-config.
#   cmake -DROOT=<source> -DWORK=<folder> -DGENERATOR=Ninja -DCXX=g++ -DCC=cc -P tests/install/install_test.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT code EQUAL 0)
    string(JOIN " " words ${ARGN})
    message(FATAL_ERROR "${words}\nends with ${code}:\n${out}${err}")
  endif()
  set(out "${out}" PARENT_SCOPE)
endfunction()

# The installed prefix is moved before use: it must not depend on the build folder.
file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/moved ${WORK}/example ${WORK}/c)
set(configure ${CMAKE_COMMAND} -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=${CXX})
# The packages of the other half: asking for one of them fails.
foreach(package OpenImageIO TinyGLTF glfw3 meshoptimizer draco)
  list(APPEND without -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
# Compiled quickly; the results are the same.
run(${configure} -S ${ROOT} -B ${WORK}/library -DKILOLUX_PROGRAM=OFF -DKILOLUX_TESTS=OFF -DKILOLUX_UNITY=ON ${without} "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG"
  -DCMAKE_INSTALL_PREFIX=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/library)
run(${CMAKE_COMMAND} --install ${WORK}/library)
file(RENAME ${WORK}/prefix ${WORK}/moved)

file(COPY ${ROOT}/host/example DESTINATION ${WORK})
run(${configure} -S ${WORK}/example -B ${WORK}/example/build -DCMAKE_PREFIX_PATH=${WORK}/moved
  "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wshadow -Wconversion -Werror")
run(${CMAKE_COMMAND} --build ${WORK}/example/build)
run(${WORK}/example/build/light_gbuffer ${WORK}/by_cmake.ppm)

# Macros begin with KILOLUX_, but for what only OpenCL C and GLSL define; one root leads to every header.
file(GLOB_RECURSE headers ${WORK}/moved/include/*.h)
foreach(header IN LISTS headers)
  file(STRINGS ${header} wrong REGEX "^ *# *(define +[A-Z]|include \"[a-z])")
  list(FILTER wrong EXCLUDE REGEX "define +(KILOLUX_|(FV|IV|UV|VW|MASK)( |$))")
  if(wrong)
    message(FATAL_ERROR "${header}: ${wrong}")
  endif()
endforeach()

# Every installed header stands alone.
file(GLOB_RECURSE headers RELATIVE ${WORK}/moved/include ${WORK}/moved/include/*.h)
list(LENGTH headers count)
if(count LESS 30)
  message(FATAL_ERROR "only ${count} headers are installed")
endif()
set(all "")
foreach(header IN LISTS headers)
  string(APPEND all "#include <${header}>\n")
endforeach()
foreach(name FV UV MASK PLANE_DEPTH SHADING_PBR SHARED_STRUCT FINE_TILE)
  string(APPEND all "#ifdef ${name}\n#error ${name} is defined\n#endif\n")
endforeach()
file(WRITE ${WORK}/all_headers.cpp "${all}")

file(GLOB_RECURSE pc ${WORK}/moved/kilolux.pc)
get_filename_component(pc_folder ${pc} DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${pc_folder})
run(pkg-config --cflags --libs kilolux)
separate_arguments(flags UNIX_COMMAND "${out}")
file(WRITE ${WORK}/version.cpp "#include <kilolux/kilolux.h>
#if KILOLUX_VERSION < KILOLUX_MAKE_VERSION(0, 1, 0) || KILOLUX_VERSION >= KILOLUX_MAKE_VERSION(1, 0, 0)
#error of another version
#endif
int main(int, char** argv) { return kilolux::version() == argv[1] ? 0 : 1; }
")
run(${CXX} ${WORK}/version.cpp ${flags} -o ${WORK}/version)
run(pkg-config --modversion kilolux)
string(STRIP "${out}" modversion)
run(${WORK}/version ${modversion})
run(${CXX} -fsyntax-only ${WORK}/all_headers.cpp ${flags})
run(${CXX} -O2 ${WORK}/example/light_gbuffer.cpp ${flags} -o ${WORK}/by_pkg_config)
run(${WORK}/by_pkg_config ${WORK}/by_pkg_config.ppm)

# A C project without C++, and pkg-config.
file(WRITE ${WORK}/c/CMakeLists.txt "cmake_minimum_required(VERSION 3.22)
project(LightPlane LANGUAGES C)
find_package(Kilolux 0.1 REQUIRED)
add_executable(light_plane light_plane.c)

target_link_libraries(light_plane PRIVATE Kilolux::c)
")
file(COPY ${ROOT}/tests/install/light_plane.c DESTINATION ${WORK}/c)
set(c_flags -std=c99 -Wall -Wextra -Wshadow -Wconversion -Wstrict-prototypes -Werror -Wno-deprecated-declarations)
list(JOIN c_flags " " c_flags_text)
run(${CMAKE_COMMAND} -G ${GENERATOR} -DCMAKE_C_COMPILER=${CC} "-DCMAKE_C_FLAGS=${c_flags_text}"
  -DCMAKE_PREFIX_PATH=${WORK}/moved -S ${WORK}/c -B ${WORK}/c/build)
run(${CMAKE_COMMAND} --build ${WORK}/c/build)
run(${WORK}/c/build/light_plane)
run(pkg-config --cflags --libs kilolux-c)
separate_arguments(flags UNIX_COMMAND "${out}")
run(${CC} ${c_flags} ${WORK}/c/light_plane.c ${flags} -o ${WORK}/c/by_pkg_config)
run(${WORK}/c/by_pkg_config)

# Both pictures are equal, and neither black nor white.
foreach(way by_cmake by_pkg_config)
  file(SHA256 ${WORK}/${way}.ppm hash_${way})
endforeach()
if(NOT hash_by_cmake STREQUAL hash_by_pkg_config)
  message(FATAL_ERROR "the two builds give different pictures")
endif()
file(READ ${WORK}/by_cmake.ppm pixels OFFSET 460000 LIMIT 3000 HEX)
string(REGEX MATCHALL ".." bytes "${pixels}")
list(REMOVE_DUPLICATES bytes)
list(LENGTH bytes different)
if(different LESS 20)
  message(FATAL_ERROR "the floor has only ${different} different bytes: ${bytes}")
endif()

# Neither OpenGL nor OpenImageIO is in the process.
run(ldd ${WORK}/example/build/light_gbuffer)
if(out MATCHES "libGL|libEGL|libepoxy|libglfw|libOpenImageIO")
  message(FATAL_ERROR "the library brings more than OpenCL:\n${out}")
endif()
