// Compiles the sources of Beast (BOOST_BEAST_SEPARATE_COMPILATION) and of the TLS part of Asio. The
// module `core` compiles the other sources of Asio.
#include <boost/asio/ssl/impl/src.hpp>
#include <boost/beast/src.hpp>
