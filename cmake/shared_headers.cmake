# Precompiles the headers that nearly every unit reads, once for each kind of target, because
# parsing them took half of the build time. build/tidy does not share headers (scripts/check_tidy),
# so it detects units with missing includes. Units with different options do not share them either
# (SKIP_PRECOMPILE_HEADERS), because GCC 12 crashes on some options that differ from those of the
# headers.
set(STRATA_STANDARD_HEADERS
  <algorithm> <array> <atomic> <bit> <charconv> <chrono> <cmath> <cstdint> <cstring> <deque> <filesystem> <fstream> <functional>
  <future> <limits> <map> <memory> <mutex> <numeric> <optional> <random> <set> <span> <sstream> <string> <string_view> <thread>
  <tuple> <unordered_map> <utility> <variant> <vector> <glm/glm.hpp> <glm/gtc/matrix_transform.hpp> <tl/expected.hpp>)
set(STRATA_NET_HEADERS ${STRATA_STANDARD_HEADERS}
  <nlohmann/json.hpp> <boost/asio/any_io_executor.hpp> <boost/asio/awaitable.hpp> <boost/asio/co_spawn.hpp>
  <boost/asio/detached.hpp> <boost/asio/ip/tcp.hpp> <boost/asio/post.hpp> <boost/asio/steady_timer.hpp>
  <boost/asio/thread_pool.hpp> <boost/asio/use_awaitable.hpp>)
set(STRATA_TESTS_HEADERS ${STRATA_STANDARD_HEADERS} <gmock/gmock.h> <gtest/gtest.h> <nlohmann/json.hpp>)

# strata_shared_headers(TARGET standard|net|tests [COMPUTES]). COMPUTES is for targets that compute
# texels and triangles. STRATA_QUICK_BUILD does not optimize other targets, because the compiler needs
# more time for it than the tests need to run without it. Tests that are not sanitized are optimized,
# because some of them compute what shaders draw.
function(strata_shared_headers target kind)
  cmake_parse_arguments(HEADERS "COMPUTES" "" "" ${ARGN})
  string(TOUPPER STRATA_${kind}_HEADERS list)
  set(options)
  if(STRATA_QUICK_BUILD AND NOT HEADERS_COMPUTES AND (STRATA_SANITIZED OR NOT kind STREQUAL tests))
    set(kind ${kind}_unoptimised)
    set(options -O0)
  endif()
  set(headers strata_${kind}_headers)
  if(NOT TARGET ${headers})
    set(unit ${PROJECT_BINARY_DIR}/shared_headers/${kind}.cpp)
    file(CONFIGURE OUTPUT ${unit} CONTENT "")
    add_library(${headers} OBJECT ${unit})
    target_link_libraries(${headers} PRIVATE glm::glm nlohmann_json::nlohmann_json strata_boost strata_warnings)
    if(TARGET GTest::gtest)
      target_link_libraries(${headers} PRIVATE GTest::gtest GTest::gmock)
    endif()
    target_compile_options(${headers} PRIVATE ${options})
    target_precompile_headers(${headers} PRIVATE ${${list}})
  endif()
  target_compile_options(${target} PRIVATE ${options})
  target_precompile_headers(${target} REUSE_FROM ${headers})
endfunction()

# strata_computes(FILE…): optimizes files that compute texels, also in a target that
# STRATA_QUICK_BUILD does not optimize. They share no headers, because their options differ from those
# of the headers.
function(strata_computes)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  if(STRATA_QUICK_BUILD)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -O1 SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()
