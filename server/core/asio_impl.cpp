// The compiled half of Boost.Asio (BOOST_ASIO_SEPARATE_COMPILATION), once for all rooms. Beast's
// half is in net.
#include <boost/asio/impl/src.hpp>
