#pragma once

#include <string>

// Areas in readable units for people; scripts get `area_m2`.
namespace strata::app {

struct AreaUnit {
  std::string name;  // "mm²"
  double per_m2 = 1;
};

// Returns the unit for areas up to this one: mm² below 1 cm², cm² below 0.1 m², as on the page.
AreaUnit readable_area(double largest_m2);

// Returns a spreadsheet's number format: four digits of the largest number, at least two decimals.
std::string number_format(double largest);

// "area_m2" → "area (mm²)", "model/layer area_m2" → "model/layer area (mm²)".
std::string readable_head(const std::string& head, const AreaUnit& unit);

}  // namespace strata::app
