# The fuzz targets, by clang's libFuzzer under the address and undefined-behaviour sanitizers, with only those sources
# that the readers need, and fmt as a library, which halves the build.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "RHEO_FUZZ needs clang (Debian packages clang-14, libclang-rt-14-dev): "
                      "configure with -DCMAKE_CXX_COMPILER=clang++-14")
endif()
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Threads REQUIRED)
find_path(TOMLPLUSPLUS_INCLUDE_DIR toml++/toml.h REQUIRED)

set(fuzz "${PROJECT_SOURCE_DIR}/tests/fuzz")
set(engine "${PROJECT_SOURCE_DIR}/engine")
set(app "${PROJECT_SOURCE_DIR}/app")
set(engine_sources
  material.cpp material_presets.cpp elastic_constants.cpp relaxation.cpp nnls.cpp prony_problem.cpp prony_selection.cpp
  prony_fit.cpp columns.cpp memory_limit.cpp memory_budget.cpp memory_need.cpp motion.cpp timeline.cpp mesh.cpp shapes.cpp
  scene.cpp
  io/bodies_reader.cpp io/body_reader.cpp io/file_access.cpp io/material_data.cpp io/material_reader.cpp io/message.cpp
  io/read_file.cpp io/region_reader.cpp io/table_file.cpp io/table_reader.cpp io/table_set.cpp io/toml_tree.cpp
  io/mesh_file.cpp io/msh_content.cpp io/msh_input.cpp io/scene_file.cpp io/scene_text.cpp io/scene_items.cpp)
list(TRANSFORM engine_sources PREPEND "${engine}/src/")
add_library(rheo_fuzz STATIC "${fuzz}/feed.cpp" ${engine_sources}
  "${app}/src/command_line.cpp" "${app}/src/command_options.cpp" "${app}/src/drawing_room.cpp"
  "${app}/src/frame_outputs.cpp" "${app}/src/memory_need.cpp" "${app}/src/nearest.cpp"
  "${app}/src/option_values.cpp" "${app}/src/overrides.cpp")
target_include_directories(rheo_fuzz PUBLIC "${fuzz}" "${engine}/include" "${engine}/src" "${app}/src")
target_include_directories(rheo_fuzz SYSTEM PRIVATE ${TOMLPLUSPLUS_INCLUDE_DIR})
target_compile_definitions(rheo_fuzz PRIVATE RHEO_VERSION="${PROJECT_VERSION}")
target_compile_options(rheo_fuzz PUBLIC -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
                       -fno-omit-frame-pointer)
target_link_libraries(rheo_fuzz PRIVATE rheo_warnings Eigen3::Eigen fmt::fmt CLI11::CLI11 Threads::Threads)

foreach(reader scene mesh command_line)
  add_executable(rheo_fuzz_${reader} "${fuzz}/target.cpp")
  target_compile_definitions(rheo_fuzz_${reader} PRIVATE RHEO_FEED=feed_${reader})
  target_link_libraries(rheo_fuzz_${reader} PRIVATE rheo_fuzz)
  target_link_options(rheo_fuzz_${reader} PRIVATE -fsanitize=fuzzer,address,undefined)
endforeach()
