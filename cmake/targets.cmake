# splice_library(NAME SOURCES a.cpp ... LINKS public-libs ... SYSTEM third-party include dirs ...)
function(splice_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;PRIVATE_LINKS;SYSTEM" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  # Headers are named from the top of the tree: "preprocess/mesh/indexed_mesh.h".
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_include_directories(${name} SYSTEM PUBLIC ${ARG_SYSTEM})
  target_link_libraries(${name} PUBLIC ${ARG_LINKS} PRIVATE ${ARG_PRIVATE_LINKS} splice_warnings)
endfunction()

# splice_program(NAME SOURCES main.cpp LINKS libs)
function(splice_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINKS} splice_warnings)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
endfunction()

# splice_test(NAME SOURCES test_x.cpp ... LINKS libs [LABELS ...]): one Catch2 executable, one ctest entry a TEST_CASE.
# An entry that names no test fails: a semicolon in a name would make two such entries of it.
function(splice_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINKS;LABELS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LINKS} splice_test_support splice_warnings)
  catch_discover_tests(${name} TEST_PREFIX "${name}: " EXTRA_ARGS -w NoTests
    PROPERTIES TIMEOUT ${ARG_TIMEOUT} LABELS "${ARG_LABELS}")
endfunction()
