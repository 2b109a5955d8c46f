# strata_module(NAME SOURCES… [PUBLIC libs…] [PRIVATE libs…]) adds one module of the server, a
# static library `strata_NAME`. A module may include only the modules that it links. The drawing in
# docs/developer/architecture/overview.md shows these links.
function(strata_module name)
  cmake_parse_arguments(MODULE "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(strata_${name} STATIC ${MODULE_SOURCES})
  target_include_directories(strata_${name} PUBLIC ${PROJECT_BINARY_DIR}/modules/${name})
  # Each module exports only its own folder, so a module finds only its own headers and those of the
  # modules that it links.
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/modules/${name})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/modules/${name}/${name} SYMBOLIC)
  if(name MATCHES "^(net|cli)$")
    strata_shared_headers(strata_${name} net)
  elseif(name MATCHES "^(domain|mesh|render|query|jobs)$")
    strata_shared_headers(strata_${name} standard COMPUTES)
  elseif(NOT name MATCHES "^(figure|report)$")  # pango needs other compiler flags
    strata_shared_headers(strata_${name} standard)
  endif()
  # These modules take more than half of the time of a release build. Units of eight files halve
  # that time. A file is compiled alone (SKIP_UNITY_BUILD_INCLUSION) if a name in its unnamed
  # namespace also exists in another file of the module.
  if(STRATA_UNITY AND name MATCHES "^(app|net|store)$")
    # at the end of the module's folder, where the properties of its files are known
    cmake_language(EVAL CODE "cmake_language(DEFER CALL strata_join_files strata_${name} Unity)")
  endif()
  target_link_libraries(strata_${name} PUBLIC ${MODULE_PUBLIC} PRIVATE ${MODULE_PRIVATE} strata_warnings)
endfunction()

# strata_join_files(TARGET FOLDER): compiles the files of a target in units of eight files, which it
# writes to this folder of the build. CMake's own unity builds contain the absolute path of each file,
# so ccache had to preprocess the units in each clone of the project. These units have the same
# content in all clones.
function(strata_join_files target folder)
  get_target_property(files ${target} SOURCES)
  set(joined)
  foreach(file ${files})
    get_source_file_property(is_alone ${file} SKIP_UNITY_BUILD_INCLUSION)
    set(has_options NO)
    foreach(option COMPILE_OPTIONS COMPILE_DEFINITIONS COMPILE_FLAGS INCLUDE_DIRECTORIES)
      get_source_file_property(value ${file} ${option})
      if(value)
        set(has_options YES)
      endif()
    endforeach()
    if(NOT is_alone AND NOT has_options)
      list(APPEND joined ${file})
    endif()
  endforeach()
  list(LENGTH joined count)
  if(count LESS 2)
    return()
  endif()
  set_source_files_properties(${joined} PROPERTIES HEADER_FILE_ONLY ON)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${folder})
  file(RELATIVE_PATH from_folder ${folder} ${CMAKE_CURRENT_SOURCE_DIR})
  set(number 0)
  while(joined)
    list(SUBLIST joined 0 8 files)
    list(REMOVE_ITEM joined ${files})
    list(TRANSFORM files REPLACE "(.+)" "#include \"${from_folder}/\\1\"\n")
    list(JOIN files "" content)
    file(CONFIGURE OUTPUT ${folder}/unity_${number}.cpp CONTENT "${content}" @ONLY)
    target_sources(${target} PRIVATE ${folder}/unity_${number}.cpp)
    math(EXPR number "${number} + 1")
  endwhile()
endfunction()

add_library(strata_warnings INTERFACE)
target_compile_options(strata_warnings INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual)
# Suppresses false warnings of GCC 12 about members of std::string (GCC bug 105651) and frames of
# Asio's coroutines.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(strata_warnings INTERFACE -Wno-array-bounds -Wno-mismatched-new-delete -Wno-restrict -Wno-stringop-overflow)
endif()
# With sanitizers, these false warnings also concern members of the standard library, because the
# sanitizer adds checks between their statements.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize" AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  target_compile_options(strata_warnings INTERFACE -Wno-maybe-uninitialized)
endif()
