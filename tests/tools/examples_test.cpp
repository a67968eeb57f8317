// The programs in tools/examples do what they say.

#include <gmock/gmock.h>

#include "tests/paths.h"
#include "tests/tools/command.h"

namespace ergon {
namespace {

using testing::HasSubstr;

class Examples : public CommandTest {
 protected:
  Answer example(const std::string& command) { return shell(test::built("/examples/") + command); }
};
class SlowExamples : public Examples {};

TEST_F(Examples, AFamilyOfLawsIsMadeCompiledAndEvaluated) {
  const Answer answer = example("hello_energy");
  EXPECT_EQ(answer.code, 0) << answer.out << answer.err;
  EXPECT_THAT(answer.out, testing::StartsWith("energy "));
}

TEST_F(Examples, ASolverOfOnesOwnConverges) {
  const Answer answer = example("own_solver_loop");
  EXPECT_EQ(answer.code, 0) << answer.out << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("the free end hangs 0."));
}

// The corners of the net bear what its knots weigh: 20 N, and 0.1 N each of the 76 others that are free.
TEST_F(Examples, ANetOverOnesOwnArraysComesToRest) {
  const Answer answer = example("own_arrays");
  EXPECT_EQ(answer.code, 0) << answer.out << answer.err;
  EXPECT_THAT(answer.out, testing::StartsWith("144 threads at rest after "));
  EXPECT_THAT(answer.out, HasSubstr("the corners bear 27.6 N of 27.6 N"));
}

// Cells are springs in a row, which is exact.
TEST_F(Examples, AModulusThatVariesIsTakenFromMemory) {
  const Answer answer = example("graded_material");
  EXPECT_EQ(answer.code, 0) << answer.out << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("data of cells:    0.0039064925 m, a row of springs gives 0.0039064925 m"));
  EXPECT_THAT(answer.out, HasSubstr("data of vertices: 0.0039"));
}

TEST_F(SlowExamples, ASurfaceIsLaidOutFlat) {
  const Answer answer = example("surface_parametrisation '" + test::source("/scenes/meshes/bunny.obj") + "' flat.obj");
  EXPECT_EQ(answer.code, 0) << answer.out << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("no triangle turned over: true"));
  // The distortion of every isometric layout is 0; that of a closed surface cut once stays below a few times its area.
  double before = 0, after = 0;
  ASSERT_EQ(std::sscanf(answer.out.c_str(), "%*d triangles laid out in %*d iterations: energy per area %lf -> %lf",
                        &before, &after),
            2);
  EXPECT_LT(after, 0.5 * before);
  EXPECT_GT(after, 0);
  EXPECT_THAT(read("flat.obj"), HasSubstr("\nf "));
  EXPECT_EQ(example("surface_parametrisation").code, 1);
}

// Of a bunny a sixth faces an axis within 15 degrees; of what becomes a cube most of it.
TEST_F(SlowExamples, ASurfaceIsStyledByItsNormals) {
  const Answer answer = example("normal_stylisation '" + test::source("/scenes/meshes/bunny.obj") + "' cube.obj");
  EXPECT_EQ(answer.code, 0) << answer.out << answer.err;
  double before = 0, after = 0;
  ASSERT_EQ(std::sscanf(answer.out.c_str(), "%*d triangles: %lf of the area along an axis before, %lf after", &before,
                        &after),
            2);
  EXPECT_LT(before, 0.2);
  EXPECT_GT(after, 0.5);
  EXPECT_THAT(read("cube.obj"), HasSubstr("\nf "));
  EXPECT_EQ(example("normal_stylisation").code, 1);
}

}  // namespace
}  // namespace ergon
