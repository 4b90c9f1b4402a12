// The generic homogeneous covariance of a set of points (Pajarola et al. 2004, section 4.2): M = sum p' p'^T with
// p' = (p, 1), a symmetric 4x4 matrix. It is additive, so a parent's is the sum of its children's (equation 4), and the
// covariance about any centre, in any frame, follows from it without looking at the points again (equation 3).
//
// In double precision, about an origin not far away: the covariance of points whose distance from the origin is d times
// their spread loses a factor d^2 of the 2^53.
#pragma once

#include <Eigen/Core>

namespace splice {

class HomogeneousCovariance {
  public:
    void add(const Eigen::Vector3d& point) {
        squares_.noalias() += point * point.transpose();
        sum_ += point;
        count_ += 1;
    }
    HomogeneousCovariance& operator+=(const HomogeneousCovariance& other) {
        squares_ += other.squares_;
        sum_ += other.sum_;
        count_ += other.count_;
        return *this;
    }

    double count() const { return count_; }
    Eigen::Vector3d mean() const { return sum_ / count_; }

    /// (1/n) sum (p - centre)(p - centre)^T, the upper left of T M T^T / n with T the translation by -centre.
    Eigen::Matrix3d about(const Eigen::Vector3d& centre) const {
        const Eigen::Matrix3d mixed = sum_ * centre.transpose();
        return (squares_ - mixed - mixed.transpose()) / count_ + centre * centre.transpose();
    }

    /// The same of the points projected along the third axis of the frame (s, t, s x t): the upper left 2x2 of the
    /// matrix in that frame.
    Eigen::Matrix2d in_plane(const Eigen::Vector3d& centre, const Eigen::Vector3d& s, const Eigen::Vector3d& t) const {
        const Eigen::Matrix3d covariance = about(centre);
        Eigen::Matrix2d plane;
        plane << s.dot(covariance * s), s.dot(covariance * t), s.dot(covariance * t), t.dot(covariance * t);
        return plane;
    }

  private:
    Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
    double count_ = 0;
};

}  // namespace splice
