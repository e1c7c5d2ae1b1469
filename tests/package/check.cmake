# Installs the engine into an empty prefix and builds and runs a consumer against it, as a user's project would.
# Variables: BUILD (build tree of rheo), SOURCE (this folder), WORK (scratch), FLAGS, COMPILER, GENERATOR
file(REMOVE_RECURSE "${WORK}")
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "failed (${code}): ${ARGN}\n${out}")
  endif()
  set(out "${out}" PARENT_SCOPE)
endfunction()
run(${CMAKE_COMMAND} --install "${BUILD}/engine" --prefix "${WORK}/prefix")
run(${CMAKE_COMMAND} -S "${SOURCE}/consumer" -B "${WORK}/build" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${WORK}/prefix"
    "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_FLAGS=${FLAGS}" -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build "${WORK}/build")
run("${WORK}/build/consumer")
if(NOT out MATCHES "1 s: tip at 3\\.036[89]")
  # 1 + u_x of node 4 at t = 1 s, lumped, from tests/data/reference/beam_lumped_t1.csv: 3.036904...; the automatic step is
  # within 1e-4 of it.
  message(FATAL_ERROR "the consumer's beam is not the paper's:\n${out}")
endif()
# Nothing of the engine's own dependencies may be asked of a consumer.
file(GLOB_RECURSE configs "${WORK}/prefix/*rheo-config.cmake")
foreach(config IN LISTS configs)
  file(STRINGS "${config}" lines REGEX "Eigen|fmt|toml")
  if(lines)
    message(FATAL_ERROR "${config} asks its users for: ${lines}")
  endif()
endforeach()
message("${out}")
