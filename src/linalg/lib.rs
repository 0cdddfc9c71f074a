//! Sparse linear algebra for the implicit time steps of cloth.
//!
//! A stiffness is an [`Operator`] of 3x3 blocks for pairs of vertices ([`pairs`]). [`LinearSolver`] solves with it by
//! conjugate gradients ([`pcg`]) over compressed rows ([`csr`]). The preconditioner is block-Jacobi with a coarse space
//! of rigid patches ([`coarse`]), whose stiffness [`cholesky`] factorises, or for specimens a sparse Cholesky factor of
//! the whole stiffness ([`exact`]). The loops run on the widest vector registers of the processor ([`simd`]).

pub mod cholesky;
pub mod coarse;
pub mod csr;
pub mod exact;
pub mod lanes;
pub mod linear;
pub mod operator;
pub mod pairs;
pub mod pcg;
pub mod quad;
pub mod rows;
pub mod simd;
pub mod stencil;
pub mod tangent;

use geom::constants::Constant;

pub use linear::LinearSolver;
pub use operator::{Contact4, Operator};
pub use pairs::PairList;

pub fn constants() -> Vec<Constant> {
    [coarse::CONSTANTS, linear::CONSTANTS].concat()
}
