# `scripts/make_package` makes strata_VERSION_ARCH.deb from two groups of files: those that
# `cmake --install` copies, and those that only a package has (the service, its settings, the
# manual page and the completion). The second group is a separate component, so
# `cmake --install --prefix` writes nothing outside the prefix.
set(debian ${PROJECT_SOURCE_DIR}/packaging/debian)
set(made ${PROJECT_BINARY_DIR}/packaging)

# scripts/setup.sh lists the programs and the libraries that are loaded at run time. dpkg-shlibdeps
# determines the linked libraries.
file(STRINGS ${PROJECT_SOURCE_DIR}/scripts/setup.sh run_packages REGEX "^run_packages=")
string(REGEX REPLACE "^run_packages=\\((.*)\\)$" "\\1" run_packages "${run_packages}")
separate_arguments(run_packages)
list(REMOVE_ITEM run_packages curl)  # only the image's health check uses it
list(APPEND run_packages adduser)
list(JOIN run_packages ", " depends)

string(TIMESTAMP STRATA_PACKAGE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(STRATA_PACKAGE_CONTACT "The Strata maintainers <maintainers@strata.invalid>" CACHE STRING "Who answers for the package")
# Reads the text of a license, beginning with `begin`, in the format of Debian's copyright file.
function(read_license file begin variable)
  file(READ ${PROJECT_SOURCE_DIR}/${file} text)
  string(REGEX REPLACE "^.*\n(${begin})" "\\1" text "${text}")
  string(STRIP "${text}" text)
  string(REPLACE "\n\n" "\n.\n" text "${text}")
  string(REPLACE "\n" "\n " text " ${text}")
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()
read_license(LICENSE "Permission is" STRATA_LICENSE)
read_license(LICENSES/OFL-1.1.txt "SIL OPEN FONT" STRATA_FONT_LICENSE)
configure_file(${debian}/changelog.in ${made}/changelog @ONLY)
configure_file(${debian}/copyright.in ${made}/copyright @ONLY)
configure_file(${debian}/strata.1.in ${made}/strata.1 @ONLY)
install(CODE "
  # lintian requires the highest compression and no time stamp.
  execute_process(COMMAND gzip -9 --no-name --stdout ${made}/changelog OUTPUT_FILE ${made}/changelog.Debian.gz COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND gzip -9 --no-name --stdout ${PROJECT_SOURCE_DIR}/CHANGELOG.md OUTPUT_FILE ${made}/changelog.gz COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND gzip -9 --no-name --stdout ${made}/strata.1 OUTPUT_FILE ${made}/strata.1.gz COMMAND_ERROR_IS_FATAL ANY)
  " COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES ${debian}/strata.service DESTINATION /lib/systemd/system COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES ${debian}/strata.default DESTINATION /etc/default RENAME strata COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES ${made}/strata.1.gz DESTINATION share/man/man1 COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES ${debian}/strata.bash DESTINATION share/bash-completion/completions RENAME strata
        COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES ${made}/copyright ${made}/changelog.gz ${made}/changelog.Debian.gz DESTINATION share/doc/strata
        COMPONENT debian EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME strata)
set(CPACK_PACKAGE_VENDOR "The Strata authors")
set(CPACK_PACKAGE_CONTACT ${STRATA_PACKAGE_CONTACT})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Archaeologists and conservators paint thematic layers onto scans, several at
once, in a browser: cracks, restorations, pigments, finds. The server draws
the pictures, with a GPU or without, and keeps every edit in PostgreSQL.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};strata;Unspecified;/" "${PROJECT_BINARY_DIR};strata;debian;/")
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS ${depends})
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
file(WRITE ${made}/conffiles "/etc/default/strata\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
    ${debian}/postinst ${debian}/prerm ${debian}/postrm ${made}/conffiles)
include(CPack)
