# Finds every library that the project links. Modules name the imported targets that they use.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(simdjson REQUIRED)
find_package(spdlog REQUIRED)
find_package(glm REQUIRED)
find_package(CLI11 REQUIRED)
find_package(PostgreSQL REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(embree 3 REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(OpenMesh REQUIRED)
find_package(Qhull REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
pkg_check_modules(DRACO REQUIRED IMPORTED_TARGET draco)
pkg_check_modules(ZIP REQUIRED IMPORTED_TARGET libzip)
pkg_check_modules(BROTLI REQUIRED IMPORTED_TARGET libbrotlienc)
pkg_check_modules(BROTLI_DECODER REQUIRED IMPORTED_TARGET libbrotlidec)  # for tests
find_package(ZLIB REQUIRED)
pkg_check_modules(ZSTD REQUIRED IMPORTED_TARGET libzstd)
pkg_check_modules(EPOXY REQUIRED IMPORTED_TARGET epoxy)
pkg_check_modules(EGL REQUIRED IMPORTED_TARGET egl)
pkg_check_modules(TURBOJPEG REQUIRED IMPORTED_TARGET libturbojpeg)
pkg_check_modules(JPEG REQUIRED IMPORTED_TARGET libjpeg)
pkg_check_modules(PNG REQUIRED IMPORTED_TARGET libpng)
pkg_check_modules(TIFF REQUIRED IMPORTED_TARGET libtiff-4)
pkg_check_modules(WEBP REQUIRED IMPORTED_TARGET libwebp)
pkg_check_modules(SHAPELIB REQUIRED IMPORTED_TARGET shapelib)
pkg_check_modules(XLSXWRITER REQUIRED IMPORTED_TARGET xlsxwriter)
pkg_check_modules(SQLITE REQUIRED IMPORTED_TARGET sqlite3)
pkg_check_modules(GEOS REQUIRED IMPORTED_TARGET geos)
pkg_check_modules(PROJ REQUIRED IMPORTED_TARGET proj)
pkg_check_modules(UTF8PROC REQUIRED IMPORTED_TARGET libutf8proc)
pkg_check_modules(CURL REQUIRED IMPORTED_TARGET libcurl)
pkg_check_modules(PANGOCAIRO REQUIRED IMPORTED_TARGET pangocairo)
pkg_check_modules(PUGIXML REQUIRED IMPORTED_TARGET pugixml)
pkg_check_modules(QPDF REQUIRED IMPORTED_TARGET libqpdf)
pkg_check_modules(LCMS REQUIRED IMPORTED_TARGET lcms2)
pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET libsodium)

# Open3D makes surfaces from points, in a program of its own (server/mesher). Its CMake package asks
# for libraries that only other parts of it need.
find_path(OPEN3D_INCLUDE open3d/geometry/PointCloud.h REQUIRED)
find_library(OPEN3D_LIBRARY Open3D REQUIRED)
find_package(fmt REQUIRED)
add_library(strata_open3d INTERFACE)
target_include_directories(strata_open3d SYSTEM INTERFACE ${OPEN3D_INCLUDE})
target_link_libraries(strata_open3d INTERFACE ${OPEN3D_LIBRARY} fmt::fmt Eigen3::Eigen)

# Eigen consists of headers. The definition makes the compiler refuse its files whose license is not
# MPL 2.0.
add_library(strata_eigen INTERFACE)
target_link_libraries(strata_eigen INTERFACE Eigen3::Eigen)
target_compile_definitions(strata_eigen INTERFACE EIGEN_MPL2_ONLY)

# Only the header of this package is used. One unit compiles the header with only the required
# formats, because the package's library also reads other formats.
find_path(STB_INCLUDE stb_image.h PATH_SUFFIXES stb REQUIRED)
add_library(strata_stb INTERFACE)
target_include_directories(strata_stb SYSTEM INTERFACE ${STB_INCLUDE})

# Raptor's Debian package conflicts with the packages of some libcurl flavors. On such a machine
# `./run` and `./test` unpack Raptor's headers into build/deps and pass their folder here. The
# library itself is the installed one.
set(STRATA_RAPTOR_INCLUDE "" CACHE PATH "Folder that holds raptor2.h, when it is not the system's")
find_path(RAPTOR_INCLUDE raptor2.h HINTS ${STRATA_RAPTOR_INCLUDE} PATH_SUFFIXES raptor2 REQUIRED)
find_library(RAPTOR_LIBRARY NAMES raptor2 libraptor2.so.0 REQUIRED)
add_library(strata_raptor INTERFACE)
target_include_directories(strata_raptor SYSTEM INTERFACE ${RAPTOR_INCLUDE})
target_link_libraries(strata_raptor INTERFACE ${RAPTOR_LIBRARY})

# Only the headers of Boost 1.81 are used (Asio, Math, Uuid, and Beast, which is compiled in one
# unit). If the machine has another version, `./run` and `./test` unpack 1.81 into build/deps and
# pass its folder here. The installed packages do not change.
set(STRATA_BOOST_INCLUDE "" CACHE PATH "Folder that holds boost/version.hpp of 1.81, when it is not the system's")
add_library(strata_boost INTERFACE)
if(STRATA_BOOST_INCLUDE)
  target_include_directories(strata_boost SYSTEM BEFORE INTERFACE ${STRATA_BOOST_INCLUDE})
endif()
target_compile_definitions(strata_boost INTERFACE BOOST_ASIO_SEPARATE_COMPILATION BOOST_BEAST_SEPARATE_COMPILATION
                                                  BOOST_ASIO_NO_DEPRECATED)
