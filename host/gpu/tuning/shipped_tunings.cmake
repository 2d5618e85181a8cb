# SPDX-License-Identifier: Apache-2.0
# Writes shipped_tunings() as C++: the tunings that certificates hold as measured on their device, by
# the run that made them or by an earlier one whose tuning it was shipped with.
#   cmake -DOUTPUT=<file.cpp> "-DFILES=<certificate.json>|..." -P host/gpu/tuning/shipped_tunings.cmake
cmake_minimum_required(VERSION 3.22)
string(REPLACE "|" ";" FILES "${FILES}")

# A row of the table, of the certificate `json`.
function(make_row json out)
  foreach(key platform name version cpu compute_units)
    string(JSON ${key} GET "${json}" device ${key})
  endforeach()
  string(JSON values GET "${json}" tuning values)
  string(JSON count LENGTH "${values}")
  math(EXPR last "${count} - 1")
  set(sets "")
  foreach(i RANGE ${last})
    string(JSON parameter MEMBER "${values}" ${i})
    string(JSON value GET "${values}" ${parameter})
    if(parameter STREQUAL "lanes")
      set(lanes ${value})
    else()
      string(APPEND sets "                t.${parameter} = ${value};\n")
    endif()
  endforeach()
  set(is_cpu false)
  if(cpu)
    set(is_cpu true)
  endif()
  set(${out} "        {R\"(${platform})\", R\"(${name})\", R\"(${version})\", ${is_cpu}, ${compute_units},
            {${lanes}, [] {
                Tuning t;
${sets}                return t;
            }()}},\n" PARENT_SCOPE)
endfunction()

set(rows "")
foreach(file IN LISTS FILES)
  file(READ ${file} json)
  string(JSON source ERROR_VARIABLE none GET "${json}" tuning source)
  if(source STREQUAL "measured here" OR source STREQUAL "shipped for this device")
    make_row("${json}" row)
    string(APPEND rows "${row}")
  endif()
endforeach()
file(WRITE ${OUTPUT} "#include <vector>

#include \"host/gpu/tuning/shipped_tunings.h\"

namespace kilolux {
std::span<const ShippedTuning> shipped_tunings() {
    static const std::vector<ShippedTuning> rows = {
${rows}    };
    return rows;
}
}  // namespace kilolux
")
