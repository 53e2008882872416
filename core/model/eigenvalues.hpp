#pragma once

#include <Eigen/Eigenvalues>

// Compiled once, in eigenvalues.cpp: it takes longer than the rest of most files that use it.
extern template Eigen::EigenSolver<Eigen::MatrixXd>& Eigen::EigenSolver<Eigen::MatrixXd>::compute(
    const Eigen::EigenBase<Eigen::MatrixXd>&, bool);
