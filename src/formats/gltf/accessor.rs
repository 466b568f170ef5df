//! Typed elements of buffers, sparse and normalized ones among them.

use super::buffers::{BufferView, Buffers};
use super::part::{List, LocatedValue};
use crate::budget::{Budget, CHECK_EVERY, Charge};
use crate::formats::{Place, ReadError};
use std::borrow::Cow;

/// How a component is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

/// Elements of one type.
#[derive(Debug)]
pub(super) struct Accessor<'a> {
    bytes: Cow<'a, [u8]>,
    stride: usize,
    pub(super) len: usize,
    pub(super) component: Component,
    pub(super) components: usize,
    pub(super) is_normalized: bool,
    /// Where it stands.
    pub(super) pointer: String,
    _charge: Option<Charge<'a>>,
}

/// The accessors of a document.
pub(super) struct Accessors<'a> {
    pub(super) list: List<'a>,
    pub(super) buffers: Buffers<'a>,
    /// Length of the file.
    pub(super) file_bytes: usize,
    pub(super) budget: &'a Budget,
}

impl Component {
    fn of(code: u64) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    pub(super) fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }
}

impl Accessors<'_> {
    /// How many elements the accessor number `index` has: no more than the file has bytes, or its buffer view where that is
    /// compressed, even where it claims to be zeros that no bytes stand behind.
    pub(super) fn claimed(&self, index: usize) -> Result<u64, ReadError> {
        let part = self.list.item(index);
        let count = part.need("count")?;
        let claimed = part.count("count")?.ok_or_else(|| count.wrong("a number of elements"))?;
        let view = part.get("bufferView").map(|view| self.buffers.decoded_bytes(&view)).transpose()?;
        let (what, bytes) = match view.flatten() {
            Some(bytes) => ("its buffer view", bytes),
            None => ("the file", self.file_bytes as u64),
        };
        if claimed > bytes {
            return Err(count.wrong(&format!("no more elements than {what} has bytes, {bytes}")));
        }
        Ok(claimed)
    }

    /// The accessor number `index`, whose elements have one of so many components.
    pub(super) fn get(&self, index: usize, components: &[usize]) -> Result<Accessor<'_>, ReadError> {
        let part = self.list.item(index);
        let kind = part.need("type")?;
        let size = match kind.value.as_str() {
            Some("SCALAR") => 1,
            Some("VEC2") => 2,
            Some("VEC3") => 3,
            Some("VEC4") => 4,
            _ => 0,
        };
        if !components.contains(&size) {
            let names: Vec<&str> =
                components.iter().map(|&size| ["SCALAR", "VEC2", "VEC3", "VEC4"][size - 1]).collect();
            return Err(kind.wrong(&names.join(" or ")));
        }
        let component = component_of(&part)?;
        let len = self.claimed(index)?;
        let element = size * component.bytes();
        let is_normalized = part.get("normalized").is_some_and(|flag| flag.value.as_bool() == Some(true));
        let of_view = part.get("bufferView").map(|view| self.buffers.view(&view)).transpose()?;
        let (bytes, stride) = match of_view {
            Some(view) => {
                let begin = part.count("byteOffset")?.unwrap_or(0);
                let bytes = elements(view, begin, len, element, &part.pointer)?;
                (Cow::Borrowed(bytes), view.stride.unwrap_or(element))
            }
            None => (Cow::Borrowed(&[][..]), element),
        };
        let mut accessor = Accessor {
            bytes,
            stride,
            len: len as usize,
            component,
            components: size,
            is_normalized,
            pointer: part.pointer.clone(),
            _charge: None,
        };
        if of_view.is_none() {
            let (mut zeros, charge) = self.budget.vec::<u8>(accessor.len * element)?;
            zeros.resize(accessor.len * element, 0);
            (accessor.bytes, accessor._charge) = (Cow::Owned(zeros), Some(charge));
        }
        match part.get("sparse") {
            Some(sparse) => self.with_sparse(accessor, &sparse, element),
            None => Ok(accessor),
        }
    }

    /// The same with the elements that `sparse` puts in the place of others.
    fn with_sparse<'s>(
        &'s self,
        base: Accessor<'s>,
        sparse: &LocatedValue<'_>,
        element: usize,
    ) -> Result<Accessor<'s>, ReadError> {
        let count = sparse.need("count")?;
        let len = sparse.count("count")?.filter(|&len| len <= base.len as u64);
        let len = len.ok_or_else(|| count.wrong("no more than the accessor has elements"))?;
        let (indices, values) = (sparse.need("indices")?, sparse.need("values")?);
        let component = component_of(&indices)?;
        let bytes_of = |part: &LocatedValue<'_>, element| {
            let view = self.buffers.view(&part.need("bufferView")?)?;
            let packed = BufferView { stride: None, ..view };
            elements(packed, part.count("byteOffset")?.unwrap_or(0), len, element, &part.pointer)
        };
        let index_bytes = bytes_of(&indices, component.bytes())?;
        let value_bytes = bytes_of(&values, element)?;
        let (mut bytes, charge) = self.budget.vec::<u8>(base.len * element)?;
        for i in 0..base.len {
            if i.is_multiple_of(CHECK_EVERY) {
                self.budget.check()?;
            }
            bytes.extend_from_slice(&base.bytes[i * base.stride..][..element]);
        }
        for i in 0..len as usize {
            if i.is_multiple_of(CHECK_EVERY) {
                self.budget.check()?;
            }
            let at = integer(component, &index_bytes[i * component.bytes()..]) as usize;
            if at >= base.len {
                let expected = format!("indices below {}, the number of elements", base.len);
                return Err(indices.wrong_with(&format!("the index {at}"), &expected));
            }
            bytes[at * element..][..element].copy_from_slice(&value_bytes[i * element..][..element]);
        }
        Ok(Accessor { bytes: Cow::Owned(bytes), stride: element, _charge: Some(charge), ..base })
    }
}

fn component_of(part: &LocatedValue<'_>) -> Result<Component, ReadError> {
    let code = part.need("componentType")?;
    let component = code.value.as_u64().and_then(Component::of);
    component.ok_or_else(|| code.wrong("5120, 5121, 5122, 5123, 5125 or 5126"))
}

/// The bytes of `len` elements from byte `begin` of `view` on.
fn elements<'v>(
    view: BufferView<'v>,
    begin: u64,
    len: u64,
    element: usize,
    pointer: &str,
) -> Result<&'v [u8], ReadError> {
    let stride = view.stride.unwrap_or(element) as u64;
    let whole = if len == 0 { 0 } else { (len - 1).saturating_mul(stride).saturating_add(element as u64) };
    let end = begin.saturating_add(whole);
    match view.bytes.get(begin as usize..end as usize) {
        Some(bytes) if end < u64::MAX => Ok(bytes),
        _ => Err(ReadError::truncated(
            Place::Whole,
            format!(
                "{end} bytes for {len} elements of {pointer}, whose buffer view has {}",
                view.bytes.len()
            ),
        )),
    }
}

impl Accessor<'_> {
    /// Component `k` of element `i`, from -1 to 1 where it is normalized.
    #[inline]
    pub(super) fn number(&self, i: usize, k: usize) -> f64 {
        let bytes = &self.bytes[i * self.stride + k * self.component.bytes()..];
        let (value, largest) = match self.component {
            Component::F32 => return f64::from(f32::from_bits(integer(Component::U32, bytes))),
            Component::I8 => (f64::from(bytes[0] as i8), 127.0),
            Component::U8 => (f64::from(bytes[0]), 255.0),
            Component::I16 => (f64::from(integer(Component::U16, bytes) as u16 as i16), 32767.0),
            Component::U16 => (f64::from(integer(Component::U16, bytes)), 65535.0),
            Component::U32 => (f64::from(integer(Component::U32, bytes)), f64::from(u32::MAX)),
        };
        if self.is_normalized { (value / largest).max(-1.0) } else { value }
    }

    /// The first `N` components of element `i`.
    #[inline]
    pub(super) fn numbers<const N: usize>(&self, i: usize) -> [f64; N] {
        std::array::from_fn(|k| self.number(i, k))
    }

    /// Element `i` as a whole number, bit for bit; for accessors of one unsigned component.
    #[inline]
    pub(super) fn integer(&self, i: usize) -> u32 {
        integer(self.component, &self.bytes[i * self.stride..])
    }
}

#[inline]
fn integer(component: Component, bytes: &[u8]) -> u32 {
    match (component.bytes(), bytes) {
        (1, &[a, ..]) => u32::from(a),
        (2, &[a, b, ..]) => u32::from(u16::from_le_bytes([a, b])),
        (4, &[a, b, c, d, ..]) => u32::from_le_bytes([a, b, c, d]),
        _ => u32::MAX,
    }
}
