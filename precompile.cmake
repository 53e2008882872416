# Precompiled headers: reading the same headers again was half of a build. Every source still includes
# what it uses; `./run lint` compiles without these (CMAKE_DISABLE_PRECOMPILE_HEADERS).
set(basic_headers <Eigen/Dense> <algorithm> <array> <cmath> <complex> <cstdint> <functional> <limits>
  <map> <memory> <numeric> <optional> <set> <span> <stdexcept> <string> <string_view> <utility>
  <variant> <vector>)
set(program_headers ${basic_headers} <chrono> <filesystem> <fstream> <sstream>
  <nlohmann/json.hpp>)

target_precompile_headers(mpm_core PRIVATE ${basic_headers})
target_precompile_headers(mpm_cli PRIVATE <CLI/CLI.hpp>)
foreach(library mpm_config mpm_idl mpm_sim)
  target_precompile_headers(${library} REUSE_FROM mpm_core)
endforeach()

target_precompile_headers(mpm_files PRIVATE ${program_headers})
foreach(library mpm_host mpm_keys mpm_mcap mpm_report mpm_history mpm_bus mpm_bag mpm_live mpm_http)
  target_precompile_headers(${library} REUSE_FROM mpm_files)
endforeach()

# Command lines: CLI11 is long to compile and soon done.
target_compile_options(mpm PRIVATE $<$<NOT:$<CONFIG:Debug>>:-O1>)
target_precompile_headers(mpm PRIVATE ${program_headers} <CLI/CLI.hpp>)
