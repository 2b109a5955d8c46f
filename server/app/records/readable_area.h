#pragma once

#include <string>

// Areas in readable units for users. Scripts get `area_m2`.
namespace strata::app {

struct AreaUnit {
  std::string name;  // "mm²"
  double per_m2 = 1;
};

// Returns the unit for areas up to this size, as on the page. It is mm² below 1 cm², cm² below 0.1
// m², and m² otherwise.
AreaUnit readable_area(double largest_m2);

// Returns a number format for spreadsheets that shows four digits of the largest number and at
// least two decimals.
std::string number_format(double largest);

// Converts "area_m2" to "area (mm²)", and "model/layer area_m2" to "model/layer area (mm²)".
std::string readable_head(const std::string& head, const AreaUnit& unit);

}  // namespace strata::app
