#include "slam/graph/factors/gaussian_prior.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "slam/core/expect.hpp"

namespace corridor::graph {
namespace {

constexpr double kZeroEigenvalueRatio = 1e-15;
// Reciprocal condition above which H surely has full rank, and a Cholesky factor, tens of times
// faster to come by than eigenvectors, is as good a root.
constexpr double kSurelyRegular = 1e-12;

}  // namespace

GaussianPrior::GaussianPrior(std::vector<Key> keys, const Values& values,
                             Eigen::MatrixXd sqrt_information, Eigen::VectorXd offset)
    : keys_(std::move(keys)),
      sqrt_information_(std::move(sqrt_information)),
      offset_(std::move(offset)) {
  int num_columns = 0;
  for (const Key key : keys_) {
    origin_.copy(key, values);
    num_columns += key.dimension();
  }
  CORRIDOR_EXPECT(sqrt_information_.cols() == num_columns &&
                  sqrt_information_.rows() == offset_.rows());
}

GaussianPrior GaussianPrior::from_information(std::vector<Key> keys, const Values& values,
                                              const Eigen::MatrixXd& H, const Eigen::VectorXd& g) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(H);
  if (cholesky.info() == Eigen::Success && cholesky.rcond() > kSurelyRegular) {
    return {std::move(keys), values, cholesky.matrixU(), cholesky.matrixL().solve(g)};
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(H);
  const double smallest = kZeroEigenvalueRatio * eigen.eigenvalues().maxCoeff();
  Eigen::MatrixXd U(H.rows(), H.cols());
  Eigen::VectorXd offset(H.rows());
  Eigen::Index num_rows = 0;
  for (Eigen::Index k = 0; k < H.rows(); ++k) {
    const double lambda = eigen.eigenvalues()(k);
    if (!(lambda > smallest)) continue;
    U.row(num_rows) = std::sqrt(lambda) * eigen.eigenvectors().col(k).transpose();
    offset(num_rows++) = eigen.eigenvectors().col(k).dot(g) / std::sqrt(lambda);
  }
  return {std::move(keys), values, U.topRows(num_rows), offset.head(num_rows)};
}

Eigen::VectorXd GaussianPrior::step(const Values& values) const {
  Eigen::VectorXd delta(sqrt_information_.cols());
  Eigen::Index row = 0;
  for (const Key key : keys_) {
    values.subtract(key, origin_, delta.data() + row);
    row += key.dimension();
  }
  return delta;
}

void GaussianPrior::residual(const Values& values, Eigen::VectorXd& r) const {
  r = sqrt_information_ * step(values) + offset_;
}

void GaussianPrior::linearize(const Values& values, Eigen::VectorXd& r, Eigen::MatrixXd& J) const {
  const Eigen::VectorXd delta = step(values);
  r = sqrt_information_ * delta + offset_;
  J = sqrt_information_;
  Eigen::Index column = 0;
  for (const Key key : keys_) {
    if (key.kind == VariableKind::kPose) {
      const Pose2::Tangent tau = delta.segment<3>(column);
      J.middleCols<3>(column) *= Pose2::right_jacobian_inverse(tau);
    }
    column += key.dimension();
  }
}

}  // namespace corridor::graph
