//! Sparse linear algebra of cloth: what a step solves, and how.
//!
//! A stiffness is an [`Operator`] of 3x3 blocks over pairs of vertices. [`LinearSolver`] solves with it by conjugate
//! gradients ([`pcg`]) over its rows ([`rows`]). The preconditioner is block-Jacobi with a coarse space of rigid patches
//! ([`patches`]), whose stiffness [`blocks`] factorises; or a sparse Cholesky factor of the whole ([`factor`]). The loops run on the widest
//! vector registers of the processor ([`machine`]).

pub mod blocks;
pub mod factor;
pub mod lanes;
pub mod linear;
pub mod machine;
pub mod operator;
mod packed;
pub mod patches;
pub mod pcg;
pub mod quad;
pub mod rows;

pub use linear::LinearSolver;
pub use operator::{Contact4, Operator, PairList};
