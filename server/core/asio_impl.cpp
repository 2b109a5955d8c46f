// Compiles Boost.Asio once for all modules (BOOST_ASIO_SEPARATE_COMPILATION). `net` compiles Beast.
#include <boost/asio/impl/src.hpp>
