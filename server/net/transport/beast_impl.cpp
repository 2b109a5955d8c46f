// The one unit that compiles Beast's own sources (BOOST_BEAST_SEPARATE_COMPILATION); Asio's are in
// core, but for its TLS.
#include <boost/asio/ssl/impl/src.hpp>
#include <boost/beast/src.hpp>
