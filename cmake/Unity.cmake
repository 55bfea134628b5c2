# elastogear_unity(target): compiles the target's sources of each folder as one unit, unless ELASTOGEAR_UNITY is off. The templates of
# Eigen, in which most of the time goes, are then instantiated once a folder. Names in anonymous namespaces must differ within a
# folder; the compiler says where they do not ("redefinition").
function(elastogear_unity target)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE path)
    cmake_path(GET path PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    string(MAKE_C_IDENTIFIER ${folder} group)
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${ELASTOGEAR_UNITY} UNITY_BUILD_MODE GROUP)
  # A class that a source alone knows may have members of such types; the warning is meant for headers, and takes an included source
  # for one.
  target_compile_options(${target} PRIVATE $<$<BOOL:${ELASTOGEAR_UNITY}>:-Wno-subobject-linkage>)
endfunction()
