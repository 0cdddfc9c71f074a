//! Answers of threads, as screens store them.

/// An answer and its request.
#[derive(Debug)]
pub struct Answered<R, T> {
    /// Request that was answered.
    pub request: R,
    /// Requested value, or the reason why there is none.
    pub outcome: Result<T, String>,
}
