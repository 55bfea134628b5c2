# ELASTOGEAR_GIT_HASH: the commit this build was configured from; stored in every file we write.
set(ELASTOGEAR_GIT_HASH "unknown")
find_package(Git QUIET)
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} -C ${PROJECT_SOURCE_DIR} rev-parse --short=12 HEAD
                  OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
  if(status EQUAL 0)
    set(ELASTOGEAR_GIT_HASH "${hash}")
  endif()
endif()
