//! Answers of threads, as screens store them.

#[derive(Debug)]
pub struct Answered<R, T> {
    pub request: R,
    pub outcome: Result<T, String>,
}
