// The compiled part of Boost.Asio (BOOST_ASIO_SEPARATE_COMPILATION), once for all modules. `net`
// compiles the part of Beast.
#include <boost/asio/impl/src.hpp>
