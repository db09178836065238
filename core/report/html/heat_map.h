// Square matrix of numbers between -1 and 1 as coloured cells; rows and columns have the same names.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical::html {

// Positive values have class "warm", negative ones "cold", with an opacity that grows with their size; each
// cell has its value as tooltip.
std::string heatMapSvg(const std::string& title, const std::vector<std::string>& names,
                       const Eigen::MatrixXd& values);

}  // namespace evical::html
