//! Methods of traits that are those of the type itself.

/// Implements methods of a trait by the methods of the same names that the type itself has.
macro_rules! forward {
    ($($name:ident($(&$this:ident)? $($owned:ident)? $(, $argument:ident: $type:ty)*) -> $result:ty;)*) => {
        $(
            forward!(@ $name, ($(&$this)? $($owned)?), ($($argument: $type),*), $result);
        )*
    };
    (@ $name:ident, (&$this:ident), ($($argument:ident: $type:ty),*), $result:ty) => {
        #[inline]
        fn $name(&$this, $($argument: $type),*) -> $result {
            $this.$name($($argument),*)
        }
    };
    (@ $name:ident, ($this:ident), ($($argument:ident: $type:ty),*), $result:ty) => {
        #[inline]
        fn $name($this, $($argument: $type),*) -> $result {
            $this.$name($($argument),*)
        }
    };
}
