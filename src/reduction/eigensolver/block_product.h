#pragma once
// A sparse matrix times many columns at once: each entry of the matrix is read once for eight of them.

#include <petscsf.h>

#include <Eigen/Core>
#include <vector>

#include "elastogear/base/petsc.h"

namespace elastogear::reduction {

using UniqueSF = Handle<PetscSF, PetscSFDestroy>;

/// A: MATAIJ, borrowed; its values must not change meanwhile. Making and calling it is collective.
class BlockProduct {
 public:
  enum class Storage { in_place, without_zeros };  ///< of M = M_s (x) I_3 two thirds are stored zeros

  explicit BlockProduct(Mat A, Storage storage = Storage::in_place);
  ~BlockProduct();
  BlockProduct(const BlockProduct&) = delete;
  BlockProduct& operator=(const BlockProduct&) = delete;

  MPI_Comm comm() const { return comm_; }
  int n_own() const { return n_own_; }  ///< rows of this rank
  int n() const { return n_; }          ///< rows of all ranks
  /// A X: own rows x columns of X. Not to be called from two threads at a time.
  Eigen::MatrixXd operator()(const Eigen::Ref<const Eigen::MatrixXd>& X) const;

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  // Compressed rows of this rank.
  struct Rows {
    const PetscInt *offset = nullptr, *column = nullptr;
    const PetscScalar* value = nullptr;
  };
  // Some columns of the own rows.
  struct Part {
    Mat A = nullptr;  // borrowed; null without zeros
    Rows rows = {};
    std::vector<PetscInt> offset = {}, column = {};  // without zeros
    std::vector<PetscScalar> value = {};
  };
  static void open(Part& part);
  static void close(Part& part);
  static void drop_zeros(Part& part, int n_rows);
  void find_ghosts(Mat A, const PetscInt* global);
  void fetch_ghosts() const;

  MPI_Comm comm_;
  int n_own_ = 0, n_ = 0, n_ghost_ = 0;
  UniqueSF ghosts_;
  Part own_, ghost_;         // columns of own rows of X, and of ghosts
  mutable RowMajor buffer_;  // own and ghost rows of X; kept, for new pages cost as much as filling them
};

}  // namespace elastogear::reduction
