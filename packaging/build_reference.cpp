// A source that is only compiled, to measure the machine's compile speed (packaging/test.sh). Not part of any program.
#include <Eigen/Dense>

#include <map>
#include <regex>
#include <string>

template <int Size>
double solved(double start) {
  Eigen::Matrix<double, Size, Size> matrix = Eigen::Matrix<double, Size, Size>::Constant(start);
  matrix.diagonal().array() += Size;
  const Eigen::Matrix<double, Size, 1> right = Eigen::Matrix<double, Size, 1>::LinSpaced(0.0, start);
  return matrix.ldlt().solve(right).sum() + matrix.inverse().trace() + (matrix * matrix.transpose()).norm();
}

double referenceWork(const std::string& text) {
  std::map<std::string, double> sums = {{"three", solved<3>(0.1)}, {"six", solved<6>(0.2)}, {"nine", solved<9>(0.3)}};
  return std::regex_match(text, std::regex("[a-z]+=[0-9.]+")) ? sums["six"] : sums["nine"];
}
