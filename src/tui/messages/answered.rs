//! Answers of threads, as screens keep them.

/// An answer with its request.
#[derive(Debug)]
pub struct Answered<R, T> {
    /// The request.
    pub request: R,
    /// The thing that was asked for, or why there is none.
    pub outcome: Result<T, String>,
}
