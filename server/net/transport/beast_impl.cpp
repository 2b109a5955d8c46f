// Compiles Beast's own sources (BOOST_BEAST_SEPARATE_COMPILATION) and those of Asio's TLS; core
// compiles the other sources of Asio.
#include <boost/asio/ssl/impl/src.hpp>
#include <boost/beast/src.hpp>
