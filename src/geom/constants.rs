//! Constants that decide results. A stored result lists their names and values.

/// A constant that decides results.
#[derive(Clone, Copy, Debug)]
pub struct Constant {
    /// Room and name, such as `contact.ccd.KEPT_SHARE`. The room is the path of the file when the constant was
    /// introduced.
    pub name: &'static str,
    pub value: fn() -> String,
}

/// Defines the constants of a file that decide results, and the list `CONSTANTS` of them.
///
/// The room is written out, so that a file may move without making stored results invalid.
#[macro_export]
macro_rules! constants {
    ($room:literal, $($(#[$meta:meta])* $vis:vis const $name:ident: $type:ty = $value:expr;)+) => {
        $($(#[$meta])* $vis const $name: $type = $value;)+

        pub(crate) const CONSTANTS: &[$crate::constants::Constant] = &[$($crate::constants::Constant {
            name: concat!($room, ".", stringify!($name)),
            value: || format!("{:?}", $name),
        }),+];
    };
}

#[cfg(test)]
mod tests {
    constants! {
        "room",
        const SHARE: f64 = 0.1;
        const SPAN_M: [f64; 2] = [1e-3, 4.0];
    }

    #[test]
    fn a_constant_is_known_by_name_and_value() {
        assert_eq!((SHARE, SPAN_M), (0.1, [1e-3, 4.0]));
        let known: Vec<(&str, String)> = CONSTANTS.iter().map(|c| (c.name, (c.value)())).collect();
        assert_eq!(known, [("room.SHARE", "0.1".to_owned()), ("room.SPAN_M", "[0.001, 4.0]".to_owned())]);
    }
}
