//! The macro that defines a level from a table with the intrinsics of each operation.

/// Declares a level in its own module: the token, the lane types `F32`, `U32`, `F64` and `Mask`, and all their traits.
/// `requires` lists the target features; it is empty if every processor of the target has them.
///
/// A row is the signature of a method and the expression that it returns: `fn min(a, b) => _mm256_min_ps(a, b);`. The
/// names in the expression are registers:
///
/// - The first parameter is `self`. Rows of `Simd` omit it, because the token has no contents.
/// - A parameter or result without a type has the type of the row's block.
/// - A slice (`from: [f32]`, `to: [f32]`) is a pointer, valid for one register, with any alignment (`stream`: aligned).
/// - A row of `F64` is evaluated for each of the two registers, unless its parameters are `low` and `high`.
/// - A `count` of bits is below 32.
/// - `last` is the highest index of a gather, from 0 to `i32::MAX`.
///
/// Rows that start with `impl` are operators. `by_hand` is the rest of the impl of `Simd`.
///
/// The expressions are evaluated in `unsafe` blocks. They may call intrinsics of the required features and access one
/// register at a pointer, but nothing else that is unsafe.
macro_rules! level {
    (
        $(#[$token_doc:meta])*
        $token:ident: $lanes:literal lanes, requires [$($feature:tt)*];
        Simd { $(fn $simd_name:ident $simd_names:tt -> $simd_result:ident => $simd_value:expr;)* }
        by_hand { $($by_hand:tt)* }
        $($(#[$doc:meta])* $type:ident($($register:ty),+): $lane_trait:ident {
            $(impl $operator:ident: $operator_name:ident $operator_names:tt => $operator_value:expr;)*
            $(fn $name:ident $names:tt $(-> $result:ident)? => $value:expr;)*
        })*
    ) => {
        token!($(#[$token_doc])* $token $($feature)*);

        const LANES: usize = $lanes;

        #[allow(unused_unsafe)] // which intrinsics are unsafe differs by target and compiler
        impl $crate::Simd for $token {
            type F32 = F32;
            type U32 = U32;
            type F64 = F64;
            type Mask = Mask;
            const LANES: usize = LANES;
            #[inline(always)]
            fn run<B: $crate::Body>(self, body: B) -> B::Output {
                $(#[target_feature(enable = $feature)])*
                #[inline(never)]
                fn inner<B: $crate::Body>(token: $token, body: B) -> B::Output {
                    body.run(token)
                }
                // SAFETY: the token proves the features.
                unsafe { inner(self, body) }
            }
            $(simd_row!($simd_name $simd_names -> $simd_result = $simd_value);)*
            $($by_hand)*
        }

        $(
            $(#[$doc])*
            #[derive(Clone, Copy, Debug)]
            pub struct $type($($register),+);

            lane_impl!($lane_trait for $token, $type {
                $(row!($type: $name $names $(-> $result)? = $value);)*
            });
            $(#[allow(unused_unsafe)]
            impl std::ops::$operator for $type {
                type Output = Self;
                row!($type: $operator_name $operator_names = $operator_value);
            })*
        )*
    };
}

/// The type of a token.
macro_rules! token {
    // Every processor of the target has the instructions.
    ($(#[$doc:meta])* $token:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default)]
        pub struct $token(());

        impl $token {
            /// The token.
            #[inline(always)]
            #[must_use]
            pub const fn new() -> $token {
                $token(())
            }
        }
    };
    ($(#[$doc:meta])* $token:ident $($feature:tt)+) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $token(());

        impl $token {
            /// The token; `None` if the processor or the operating system does not support the instructions.
            #[inline]
            #[must_use]
            pub fn detect() -> Option<$token> {
                ($(is_x86_feature_detected!($feature))&&+).then_some($token(()))
            }

            /// The token without a check.
            ///
            /// # Safety
            /// [`Self::detect`] must return a token on this machine.
            #[inline(always)]
            #[must_use]
            pub unsafe fn new_unchecked() -> $token {
                $token(())
            }
        }
    };
}

/// The impl of a trait of lanes.
macro_rules! lane_impl {
    (MaskLanes for $token:ident, $type:ident { $($rows:tt)* }) => {
        #[allow(unused_unsafe)]
        impl $crate::MaskLanes for $type { const LANES: usize = LANES; $($rows)* }
    };
    ($trait:ident for $token:ident, $type:ident { $($rows:tt)* }) => {
        #[allow(unused_unsafe)]
        impl $crate::$trait<$token> for $type { $($rows)* }
    };
}

/// Evaluates the expression of a row, in which the names have these values.
macro_rules! evaluate {
    ($value:expr; $($name:ident = $of:expr),*) => {{
        $(let $name = $of;)*
        // SAFETY: tokens and lane values have private contents, and lane values come from a token, which exists only if
        // the processor has the required features. The pointers come from slices whose length was checked.
        unsafe { $value }
    }};
}

/// A method of `Simd`, defined by its row.
macro_rules! simd_row {
    // load_f64
    ($name:ident ($from:ident: [$element:ty]) -> F64 = $value:expr) => {
        #[inline(always)]
        fn $name(self, $from: &[$element]) -> F64 {
            let from = &$from[..LANES];
            F64(evaluate!($value; $from = from.as_ptr()), evaluate!($value; $from = from[LANES / 2..].as_ptr()))
        }
    };
    // load, load_u32
    ($name:ident ($from:ident: [$element:ty]) -> $result:ident = $value:expr) => {
        #[inline(always)]
        fn $name(self, $from: &[$element]) -> $result {
            let from = &$from[..LANES];
            $result(evaluate!($value; $from = from.as_ptr()))
        }
    };
    // gather, gather_u32
    ($name:ident ($from:ident: [$element:ident], $index:ident: U32, $last:ident: i32) -> $result:ident = $value:expr) => {
        #[inline(always)]
        fn $name(self, $from: &[$element], $index: U32) -> $result {
            let Some(last) = $crate::table::last_index($from.len()) else {
                return $crate::Simd::$element(self, $element::default());
            };
            $result(evaluate!($value; $from = $from.as_ptr(), $index = $index.0, $last = last))
        }
    };
    // lookup8, lookup16
    ($name:ident ($table:ident: $table_type:ident, $index:ident: U32) -> $result:ident = $value:expr) => {
        #[inline(always)]
        fn $name(self, $table: $table_type, $index: U32) -> $result {
            $result(evaluate!($value; $table = $table.0, $index = $index.0))
        }
    };
    // f64
    ($name:ident ($number:ident: $number_type:ty) -> F64 = $value:expr) => {
        #[inline(always)]
        fn $name(self, $number: $number_type) -> F64 {
            F64(evaluate!($value;), evaluate!($value;))
        }
    };
    // f32, u32, iota, table8, table16
    ($name:ident ($($from:ident: $from_type:ty)?) -> $result:ident = $value:expr) => {
        #[inline(always)]
        fn $name(self $(, $from: $from_type)?) -> $result {
            $result(evaluate!($value;))
        }
    };
}

/// A method of lanes, defined by its row.
macro_rules! row {
    (F64: store($a:ident, $to:ident: [$element:ty]) = $value:expr) => {
        #[inline(always)]
        fn store(self, $to: &mut [$element]) {
            let to = &mut $to[..LANES];
            evaluate!($value; $a = self.0, $to = to.as_mut_ptr());
            evaluate!($value; $a = self.1, $to = to[LANES / 2..].as_mut_ptr());
        }
    };
    (F64: words($low:ident, $high:ident) = $value:expr) => {
        #[inline(always)]
        fn words(self) -> (U32, U32) {
            let (low, high) = evaluate!($value; $low = self.0, $high = self.1);
            (U32(low), U32(high))
        }
    };
    // narrow
    (F64: $name:ident($low:ident, $high:ident) -> $result:ident = $value:expr) => {
        #[inline(always)]
        fn $name(self) -> $result {
            $result(evaluate!($value; $low = self.0, $high = self.1))
        }
    };
    // All other methods of F64.
    (F64: $name:ident($a:ident $(, $b:ident)*) = $value:expr) => {
        #[inline(always)]
        fn $name(self $(, $b: Self)*) -> Self {
            F64(evaluate!($value; $a = self.0 $(, $b = $b.0)*), evaluate!($value; $a = self.1 $(, $b = $b.1)*))
        }
    };
    // widen
    ($type:ident: $name:ident($a:ident) -> F64 = $value:expr) => {
        #[inline(always)]
        fn $name(self) -> F64 {
            let (low, high) = evaluate!($value; $a = self.0);
            F64(low, high)
        }
    };
    // to_bits
    ($type:ident: $name:ident($a:ident) -> u32 = $value:expr) => {
        #[inline(always)]
        fn $name(self) -> u32 {
            evaluate!($value; $a = self.0)
        }
    };
    // shl, shr, sar
    ($type:ident: $name:ident($a:ident, $count:ident: u32) = $value:expr) => {
        #[inline(always)]
        fn $name(self, $count: u32) -> Self {
            Self(evaluate!($value; $a = self.0, $count = $count & 31))
        }
    };
    ($type:ident: store($a:ident, $to:ident: [$element:ty]) = $value:expr) => {
        #[inline(always)]
        fn store(self, $to: &mut [$element]) {
            let to = &mut $to[..LANES];
            evaluate!($value; $a = self.0, $to = to.as_mut_ptr());
        }
    };
    ($type:ident: stream($a:ident, $to:ident: [$element:ty]) = $value:expr) => {
        #[inline(always)]
        fn stream(self, $to: &mut [$element], _: &$crate::Stream) {
            if $to.len() >= LANES && $to.as_ptr().addr().is_multiple_of(size_of::<Self>()) {
                // Dropping the `Stream` waits for the store.
                evaluate!($value; $a = self.0, $to = $to.as_mut_ptr());
            } else {
                self.store_partial($to);
            }
        }
    };
    // All other methods.
    ($type:ident: $name:ident($a:ident $(, $b:ident $(: $b_type:ident)?)*) = $value:expr) => {
        row!($type: $name($a $(, $b $(: $b_type)?)*) -> Self = $value);
    };
    ($type:ident: $name:ident($a:ident $(, $b:ident $(: $b_type:ident)?)*) -> $result:ident = $value:expr) => {
        #[inline(always)]
        fn $name(self $(, $b: type_or_self!($($b_type)?))*) -> $result {
            $result(evaluate!($value; $a = self.0 $(, $b = $b.0)*))
        }
    };
}

/// The type of a parameter of a row.
macro_rules! type_or_self {
    () => {
        Self
    };
    ($type:ident) => {
        $type
    };
}

/// The highest index of a gather. Its indices are signed 32-bit, so the rest of a larger slice cannot be reached.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn last_index(length: usize) -> Option<i32> {
    length.checked_sub(1).map(|last| i32::try_from(last).unwrap_or(i32::MAX))
}
