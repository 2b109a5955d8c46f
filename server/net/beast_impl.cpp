// The one unit that compiles Beast's own sources (BOOST_BEAST_SEPARATE_COMPILATION); Asio's are in core.
#include <boost/beast/src.hpp>
