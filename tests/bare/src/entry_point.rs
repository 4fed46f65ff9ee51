//! One symbol per public function and precision: `f32::Spring::tension`, `f64::MassSpring::step[drag]`.
//!
//! A wrapper is named after the function that it is there for; in brackets stands what it is called with, where that
//! makes other code. The names are what `entries.sh` compares with the functions that core has.

/// Makes the wrappers `Type::function[with](arguments) -> answer { body }` in both precisions; `T` is the precision.
macro_rules! entry_points {
    ($($body:tt)*) => {
        mod single {
            use super::*;
            type T = f32;
            $crate::entry_point::in_one_precision! { "f32::" $($body)* }
        }
        mod double {
            use super::*;
            type T = f64;
            $crate::entry_point::in_one_precision! { "f64::" $($body)* }
        }
    };
}

macro_rules! in_one_precision {
    ($precision:literal $(
        $of:ident::$name:ident $([$with:ident])? $(<$life:lifetime>)? ($($argument:ident: $type:ty),* $(,)?) $(-> $answer:ty)? $body:block
    )*) => {
        $(const _: () = {
            #[unsafe(export_name = concat!(
                $precision, stringify!($of), "::", stringify!($name) $(, "[", stringify!($with), "]")?
            ))]
            pub fn wrapper$(<$life>)?($($argument: $type),*) $(-> $answer)? $body
        };)*
    };
}

pub(crate) use {entry_points, in_one_precision};
