# Installs the build tree BUILD under WORK/prefix, then configures, builds and runs the program beside this file.
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/elastogear_user)
run(${WORK}/prefix/bin/elastogear -help)
if(PYTHON)  # the installed module, not that of the build tree
  file(GLOB packages ${WORK}/prefix/lib/python*/dist-packages)
  run(${CMAKE_COMMAND} -E env PYTHONPATH=${packages} ${PYTHON} -B -c
      "import elastogear as eg; assert eg.__file__.startswith('${WORK}'); print(eg.describe('${MESH}'))")
endif()
