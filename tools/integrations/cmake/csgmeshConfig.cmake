# SPDX-License-Identifier: MIT
# find_package(csgmesh) gives:
#
#   csgmesh_add_mesh(TARGET SCENE scene.txt
#                    [FORMATS glb stl ...]        default glb
#                    [RESOLUTION n]               cells along the longest side
#                    [DEFINES name=value ...]     as -D
#                    [PARAMETER_FILE sets.json SETS small large ...]   a mesh for each set
#                    [INCLUDE folder ...]         as -I
#                    [OPTIONS ...]                more options of csgmesh mesh
#                    [NAME name]                  of the outputs, default: the scene's
#                    [OUTPUT_DIRECTORY folder]    default: the current build folder
#                    [THREADS n]                  of one csgmesh, default 1: the build runs many
#                    [ALL])                       part of the default build
#
# TARGET makes NAME[-SET].FORMAT; its property CSGMESH_OUTPUTS lists them. What the scene reads
# (includes, imports, fonts) is noted in a dependency file: a change remakes what depends on it.
# CSGMESH_EXECUTABLE names the program.
cmake_minimum_required(VERSION 3.21)

find_program(CSGMESH_EXECUTABLE csgmesh HINTS "${CMAKE_CURRENT_LIST_DIR}/../../../bin")
if(NOT CSGMESH_EXECUTABLE)
  set(csgmesh_FOUND FALSE)
  set(csgmesh_NOT_FOUND_MESSAGE "the program csgmesh was not found; set CSGMESH_EXECUTABLE")
  return()
endif()

function(_csgmesh_absolute out base)
  set(result)
  foreach(path IN LISTS ARGN)
    cmake_path(ABSOLUTE_PATH path BASE_DIRECTORY "${base}" NORMALIZE)
    list(APPEND result "${path}")
  endforeach()
  set(${out} "${result}" PARENT_SCOPE)
endfunction()

# One command: all formats of one set.
function(_csgmesh_add_command outputs_variable)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "SCENE;STEM;DIRECTORY;THREADS" "FORMATS;ARGUMENTS;DEPENDS")
  set(made)
  set(words)
  foreach(format IN LISTS arg_FORMATS)
    list(APPEND made "${arg_DIRECTORY}/${arg_STEM}.${format}")
    list(APPEND words -o "${arg_DIRECTORY}/${arg_STEM}.${format}")
  endforeach()
  list(GET made 0 first)
  add_custom_command(
    OUTPUT ${made}
    COMMAND "${CMAKE_COMMAND}" -E make_directory "${arg_DIRECTORY}"
    COMMAND "${CSGMESH_EXECUTABLE}" -j "${arg_THREADS}" "${arg_SCENE}" ${words} ${arg_ARGUMENTS} -M "${first}.d"
    DEPENDS "${arg_SCENE}" ${arg_DEPENDS}
    DEPFILE "${first}.d"
    COMMENT "Meshing ${arg_STEM}"
    VERBATIM)
  set(${outputs_variable} ${${outputs_variable}} ${made} PARENT_SCOPE)
endfunction()

function(csgmesh_add_mesh target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "ALL" "SCENE;RESOLUTION;PARAMETER_FILE;NAME;OUTPUT_DIRECTORY;THREADS"
                        "FORMATS;DEFINES;SETS;INCLUDE;OPTIONS")
  if(NOT arg_SCENE OR arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "csgmesh_add_mesh(${target}): SCENE is missing, or unknown: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if((arg_SETS AND NOT arg_PARAMETER_FILE) OR (arg_PARAMETER_FILE AND NOT arg_SETS))
    message(FATAL_ERROR "csgmesh_add_mesh(${target}): PARAMETER_FILE and SETS go together")
  endif()
  if(NOT arg_FORMATS)
    set(arg_FORMATS glb)
  endif()
  if(NOT arg_THREADS)
    set(arg_THREADS 1)
  endif()
  if(NOT arg_OUTPUT_DIRECTORY)
    set(arg_OUTPUT_DIRECTORY ".")
  endif()
  if(NOT arg_NAME)
    cmake_path(GET arg_SCENE STEM LAST_ONLY arg_NAME)
  endif()
  _csgmesh_absolute(scene "${CMAKE_CURRENT_SOURCE_DIR}" "${arg_SCENE}")
  _csgmesh_absolute(folder "${CMAKE_CURRENT_BINARY_DIR}" "${arg_OUTPUT_DIRECTORY}")
  _csgmesh_absolute(include "${CMAKE_CURRENT_SOURCE_DIR}" ${arg_INCLUDE})
  set(words ${arg_OPTIONS})
  if(arg_RESOLUTION)
    list(APPEND words -r "${arg_RESOLUTION}")
  endif()
  foreach(define IN LISTS arg_DEFINES)
    list(APPEND words -D "${define}")
  endforeach()
  foreach(path IN LISTS include)
    list(APPEND words -I "${path}")
  endforeach()
  set(outputs)
  if(arg_SETS)
    _csgmesh_absolute(file "${CMAKE_CURRENT_SOURCE_DIR}" "${arg_PARAMETER_FILE}")
    foreach(name IN LISTS arg_SETS)
      _csgmesh_add_command(outputs SCENE "${scene}" STEM "${arg_NAME}-${name}" DIRECTORY "${folder}"
        THREADS "${arg_THREADS}" FORMATS ${arg_FORMATS} ARGUMENTS ${words} -p "${file}" -P "${name}" DEPENDS "${file}")
    endforeach()
  else()
    _csgmesh_add_command(outputs SCENE "${scene}" STEM "${arg_NAME}" DIRECTORY "${folder}"
      THREADS "${arg_THREADS}" FORMATS ${arg_FORMATS} ARGUMENTS ${words})
  endif()
  set(all)
  if(arg_ALL)
    set(all ALL)
  endif()
  add_custom_target(${target} ${all} DEPENDS ${outputs})
  set_property(TARGET ${target} PROPERTY CSGMESH_OUTPUTS "${outputs}")
endfunction()
