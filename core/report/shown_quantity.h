// Calibrated quantities in displayed units, number by number. Tables, the report and the window display them.
#pragma once

#include "core/report/result_yaml.h"

#include "core/data/quantity.h"
#include "core/data/quantity_address.h"

#include <string>
#include <vector>

namespace evical {

struct ShownNumber {
  std::string key;   // as in a comparison of results (quantity_difference.h): "left.rotation.x"
  std::string part;  // "x", "yz", "focal length y"; empty of a scalar
  std::string unit;
  double value = 0.0, sigma = 0.0;  // sigma 0: not estimated
};

struct ShownQuantity {
  const QuantityInfo* info = nullptr;
  std::vector<ShownNumber> numbers;
};

// All present quantities, in the order of quantity.h; the pose can be omitted, which a reference does not
// have.
std::vector<ShownQuantity> shownCamera(const NamedResult& named, std::size_t camera, bool with_place = true);
std::vector<ShownQuantity> shownImu(const NamedResult& named, std::size_t imu, bool with_place = true);
// Empty if the board's size is fixed; for a further board also its pose in the world.
std::vector<ShownQuantity> shownBoard(const NamedResult& named, std::size_t board);
BoardUncertainty boardUncertainty(const UncertaintyReport& report,
                                  std::size_t board);                 // all 0 if absent
std::string boardTitle(const NamedResult& named, std::size_t board);  // "Board", or "Board tags" of several

// "ms against the gyroscope"
std::string unitAndRemark(const ShownQuantity& quantity);

// Elements of a 3 x 3 matrix: scales on the diagonal, misalignments off it.
bool isScale(const ShownNumber& number);

// Names of estimated numbers, for people and for tables.

// "camera: left, quantity: gyroscope_bias, component: x", as result.yaml has it.
std::string columnKeys(const QuantityAddress& number, const NamedResult& named);

// "left.gyroscope_bias.x [rad/s]", for all columns of the result's covariance.
std::vector<std::string> columnNames(const NamedResult& named);

struct QuantityWords {
  std::string sensor;    // "left"
  std::string quantity;  // "gyroscope bias"
  std::string part;      // "x", "xy"; empty if the quantity is one number
};

QuantityWords quantityWords(const QuantityAddress& number, const NamedResult& named);

// "left: gyroscope bias x"
std::string quantitySentence(const QuantityWords& words);

}  // namespace evical
