# Flags of all our own code. No fast-math and no FMA contraction: the same bytes from every compiler.
# Without errno a square root is one instruction and no branch; no result depends on it.
function(meshfarm_compile_options target)
  # Options structs are made with designated initialisers: a field that is not named has its
  # documented default, which -Wmissing-field-initializers would not allow.
  # g++ 12 reports -Wrestrict falsely on std::string operator+ (GCC bug 105651).
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -Wno-missing-field-initializers -ffp-contract=off -fno-math-errno
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  if(MESHFARM_SANITIZE)
    # UBSan's checks null and vptr are left out: using a null pointer ends the program anyway, and
    # nothing is cast down to a class with virtual functions. With -O2, tests run a quarter faster
    # than with these checks and -O1, and are compiled a sixth faster.
    target_compile_options(${target} PRIVATE -fsanitize=${MESHFARM_SANITIZE} -fno-sanitize=null,vptr
                                             -fno-omit-frame-pointer -fno-sanitize-recover=all -O2 -g1)
    target_link_options(${target} PRIVATE -fsanitize=${MESHFARM_SANITIZE})
  endif()
  if(MESHFARM_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()

# Flags of a test program. Most of its time goes into compiling it, so its own code is not optimised.
# OWN_MAIN: its sources have the main function.
function(meshfarm_test_options target)
  cmake_parse_arguments(ARG "OWN_MAIN" "" "" ${ARGN})
  if(NOT TARGET meshfarm_doctest_main)
    add_library(meshfarm_doctest_main OBJECT ${PROJECT_SOURCE_DIR}/tests/support/doctest_main.cpp)
    target_include_directories(meshfarm_doctest_main PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    meshfarm_compile_options(meshfarm_doctest_main)
    add_library(meshfarm_test_meshes STATIC ${PROJECT_SOURCE_DIR}/tests/support/meshes.cpp)
    target_include_directories(meshfarm_test_meshes PRIVATE ${PROJECT_SOURCE_DIR}/include)
    meshfarm_compile_options(meshfarm_test_meshes)
  endif()
  target_link_libraries(${target} PRIVATE meshfarm_test_meshes)
  if(NOT ARG_OWN_MAIN)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:meshfarm_doctest_main>)
  endif()
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  meshfarm_compile_options(${target})
  set(flags -O0 -DDOCTEST_CONFIG_SUPER_FAST_ASSERTS -DDOCTEST_CONFIG_NO_TRY_CATCH_IN_ASSERTS)
  target_compile_options(${target} PRIVATE ${flags})
  meshfarm_precompile(${target} tests "${flags}" <doctest/doctest.h>)
endfunction()

# Compiles sources several together. Then a local name may be one of another source's unnamed
# namespace, and g++ takes these namespaces for ones of a header.
function(meshfarm_compile_together target sources)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${sources})
  target_compile_options(${target} PRIVATE
    -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# meshfarm_precompile(TARGET KIND FLAGS [HEADER...])
# The headers that most sources include are compiled once for all targets of a kind (layers, tests),
# whose flags must be the same: those of meshfarm_compile_options() and FLAGS.
function(meshfarm_precompile target kind flags)
  if(MESHFARM_UNITY STREQUAL "OFF")
    return()
  endif()
  set(headers meshfarm_headers_of_${kind})
  if(NOT TARGET ${headers})
    file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/${headers}.cpp CONTENT "")
    add_library(${headers} OBJECT ${PROJECT_BINARY_DIR}/${headers}.cpp)
    meshfarm_compile_options(${headers})
    target_compile_options(${headers} PRIVATE ${flags})
    target_precompile_headers(${headers} PRIVATE
      <algorithm> <array> <atomic> <bit> <charconv> <chrono> <cmath> <cstdint> <cstring>
      <filesystem> <fstream> <functional> <iostream> <limits> <map> <memory> <mutex> <numeric>
      <optional> <set> <span> <sstream> <string> <string_view> <thread> <unordered_map> <utility>
      <variant> <vector> ${ARGN})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${headers})
  # To g++ a header that was precompiled is no system header any more: it warns falsely of <string>.
  foreach(warning array-bounds stringop-overflow stringop-overread)
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-${warning}>)
  endforeach()
endfunction()

# The program finds the module beside itself where both were built, and installed.
function(meshfarm_loads program name)
  add_dependencies(${program} meshfarm_${name})
  set_target_properties(${program} PROPERTIES
    BUILD_RPATH "$ORIGIN" INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/meshfarm")
endfunction()

# The longest tests are started first: a limit (TIMEOUT) is taken for the cost. Sanitizers make
# programs several times slower.
function(meshfarm_limit_test name limit)
  set(seconds ${limit})
  if(MESHFARM_SANITIZE)
    math(EXPR seconds "${limit} * 4")
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${seconds} COST ${limit})
endfunction()

# meshfarm_layer(io USES geometry PACKAGES Boost::iostreams)
# One folder = one layer = one static library meshfarm_<name> = one unit-test program test_<name>.
# Most of the time of a compiler goes into the headers. No two sources of a layer define the same name,
# so that they can be compiled together (MESHFARM_UNITY), as unit tests always are. What g++ makes of
# them then is 3 % slower. TOGETHER: the layer computes little, so that this does not matter.
# TESTS_APART: a word; test cases that have it in their name are run beside the others.
# MODULE: the program loads it when it needs it (meshfarm_loads()). It sees only the headers of what it
# uses.
function(meshfarm_layer name)
  cmake_parse_arguments(ARG "MODULE;TOGETHER" "TESTS_APART" "USES;PACKAGES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS src/${name}/*.cpp src/${name}/*/*.cpp)
  list(TRANSFORM ARG_USES PREPEND meshfarm_ OUTPUT_VARIABLE uses)
  if(ARG_MODULE)
    add_library(meshfarm_${name} MODULE ${sources})
    set(linked_by_tests ${uses} ${ARG_PACKAGES})
  else()
    add_library(meshfarm_${name} STATIC ${sources})
    add_library(meshfarm::${name} ALIAS meshfarm_${name})
    set_target_properties(meshfarm_${name} PROPERTIES EXPORT_NAME ${name})
    target_link_libraries(meshfarm_${name} PUBLIC ${uses})
    set(linked_by_tests meshfarm_${name})
  endif()
  target_include_directories(meshfarm_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:include>)
  target_include_directories(meshfarm_${name} PRIVATE ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(meshfarm_${name} PRIVATE ${ARG_PACKAGES} Threads::Threads)
  meshfarm_compile_options(meshfarm_${name})
  if(NOT ARG_MODULE AND (MESHFARM_UNITY STREQUAL "ON" OR (MESHFARM_UNITY STREQUAL "AUTO" AND ARG_TOGETHER)))
    meshfarm_compile_together(meshfarm_${name} 24)
    meshfarm_precompile(meshfarm_${name} layers "")
  endif()

  file(GLOB tests CONFIGURE_DEPENDS tests/unit/${name}/test_*.cpp)
  if(MESHFARM_TESTS AND tests)
    add_executable(test_${name} ${tests})
    target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(test_${name} PRIVATE ${linked_by_tests} Threads::Threads)
    if(ARG_MODULE)
      meshfarm_loads(test_${name} ${name})
    else()
      # The linker takes an inline function from the first file that has it: here from a layer, where
      # it is optimised, and not from a test.
      list(TRANSFORM uses REPLACE ".+" "$<TARGET_FILE:\\0>" OUTPUT_VARIABLE first)
      list(JOIN first , first)
      target_link_options(test_${name} PRIVATE
        "LINKER:--whole-archive,$<TARGET_FILE:meshfarm_${name}>,${first},--no-whole-archive")
    endif()
    meshfarm_test_options(test_${name})
    meshfarm_compile_together(test_${name} 24)
    set(names unit.${name})
    if(ARG_TESTS_APART)
      list(APPEND names unit.${name}.${ARG_TESTS_APART})
      add_test(NAME unit.${name} COMMAND test_${name} --test-case-exclude=*${ARG_TESTS_APART}*)
      add_test(NAME unit.${name}.${ARG_TESTS_APART}
               COMMAND test_${name} --test-case=*${ARG_TESTS_APART}*)
    else()
      add_test(NAME unit.${name} COMMAND test_${name})
    endif()
    foreach(test ${names})
      meshfarm_limit_test(${test} 900)
      set_tests_properties(${test} PROPERTIES LABELS unit)
    endforeach()
  endif()
endfunction()
