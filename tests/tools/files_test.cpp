#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "runtime/error.h"
#include "tests/runtime/temporary_folder.h"
#include "tools/matrix_market.h"
#include "tools/positions.h"

namespace ergon {
namespace {

class Files : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) { std::ofstream(folder + name) << text; }
  std::string read(const std::string& name) {
    std::ostringstream text;
    text << std::ifstream(folder + name).rdbuf();
    return text.str();
  }
  // The message of the InputError for these positions, without the folder's name.
  std::string positions_error(const std::string& text, int vertices) {
    write("x.txt", text);
    try {
      read_positions(folder + "x.txt", vertices);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(folder.size());
    }
    return "no error";
  }

  const TemporaryFolder own;
  const std::string folder = own.path("");
};

TEST_F(Files, PositionsAreReadWithCommentsAndEmptyLines) {
  write("x.txt", "# a header\n1 2 3\n\n  -4.5e-1\t5 6 # the second\n");
  Eigen::Matrix3Xd expected(3, 2);
  expected << 1, -0.45, 2, 5, 3, 6;
  EXPECT_EQ(read_positions(folder + "x.txt", 2), expected);
}

TEST_F(Files, PositionsThatAreWrongNameTheLine) {
  EXPECT_EQ(positions_error("1 2 3\n1 nan 3\n", 2), "x.txt:2: 'nan' is not a finite number");
  EXPECT_EQ(positions_error("1 2 3m\n", 1), "x.txt:1: '3m' is not a finite number");
  EXPECT_EQ(positions_error("1 2\n", 1), "x.txt:1: 2 numbers, a vertex has 3");
  EXPECT_EQ(positions_error("1 2 3\n", 4), "x.txt: 1 vertices, the mesh has 4");
}

TEST_F(Files, MatrixMarketKeepsEveryDigitAndOnlyTheLowerTriangle) {
  BlockMatrix matrix(2, {{0, 0}, {1, 1}, {1, 0}});
  for (size_t i = 0; i < matrix.values().size(); ++i) matrix.values()[i] = 1.0 / (3.0 + double(i));
  write_matrix_market(folder + "H.mtx", matrix);

  std::istringstream text(read("H.mtx"));
  std::string header;
  std::getline(text, header);
  EXPECT_EQ(header, "%%MatrixMarket matrix coordinate real symmetric");
  int rows = 0, cols = 0, count = 0;
  text >> rows >> cols >> count;
  EXPECT_EQ(rows, 6);
  EXPECT_EQ(cols, 6);
  EXPECT_EQ(count, 21);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(6, 6);
  for (int k = 0; k < count; ++k) {
    int i = 0, j = 0;
    double value = 0;
    text >> i >> j >> value;
    EXPECT_GE(i, j);
    dense(i - 1, j - 1) = value;
  }
  const Eigen::MatrixXd full = dense.selfadjointView<Eigen::Lower>();
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(6, -1, 2);
  Eigen::VectorXd y;
  matrix.multiply(x, y);
  EXPECT_LT((full * x - y).norm(), 1e-15);
}

TEST_F(Files, AFolderThatIsNotThereIsBadInputAndLeavesNothing) {
  const std::string path = folder + "missing/g.mtx";
  try {
    write_matrix_market(path, Eigen::Matrix3Xd::Zero(3, 1));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), path + ": cannot be made: No such file or directory");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder));
}

}  // namespace
}  // namespace ergon
