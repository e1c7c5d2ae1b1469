# Configures and builds the fuzz targets with clang, in a folder of their own: a test's first step.
#
#   cmake -DSOURCE=... -DBUILD=... -DCLANG=clang++ -DGENERATOR=Ninja -P build.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}:\n${output}")
  endif()
endfunction()

string(REPLACE "clang++" "clang" clang_c "${CLANG}")
run(${CMAKE_COMMAND} -S "${SOURCE}" -B "${BUILD}" -G "${GENERATOR}" -DRHEO_FUZZ=ON
    -DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS_DEBUG=-O1 -g1" "-DCMAKE_CXX_COMPILER=${CLANG}"
    "-DCMAKE_C_COMPILER=${clang_c}")
run(${CMAKE_COMMAND} --build "${BUILD}" --parallel 2)
foreach(reader scene mesh command_line)
  file(MAKE_DIRECTORY "${BUILD}/corpus_${reader}")
endforeach()
file(MAKE_DIRECTORY "${BUILD}/findings")
