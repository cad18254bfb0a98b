//! The messages between a page and the program that sends it lists.
//!
//! The page sends a greeting as JSON. All later messages are binary: the length of a header as four
//! little-endian bytes, the header as JSON, and bytes.

use crate::calls::CallList;
use etalon_backend::BackendError;
use etalon_frame::DeviceOffer;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// The version of the protocol.
pub const PROTOCOL: u32 = 1;

/// The first message of a page.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub enum Greeting {
    /// The page has a device.
    Hello(Box<Hello>),
    /// The page has no device.
    Unavailable {
        /// The version of the page's protocol.
        protocol: u32,
        /// The reason why there is no device.
        unavailable: String,
    },
}

/// A device as a page describes it.
#[derive(Debug, Deserialize)]
pub struct Hello {
    /// The version of the page's protocol.
    pub protocol: u32,
    /// The browser.
    pub browser: Named,
    /// The adapter of the device.
    pub adapter: BrowserAdapter,
    /// The features and limits that the device offers.
    #[serde(flatten)]
    pub offer: DeviceOffer,
}

/// A browser.
#[derive(Debug, Deserialize)]
pub struct Named {
    /// The name.
    pub name: String,
    /// The version; empty if it is unknown.
    pub version: String,
}

/// GPUAdapterInfo. Browsers leave members empty that would identify a person's machine.
#[derive(Debug, Deserialize)]
pub struct BrowserAdapter {
    /// The vendor.
    pub vendor: String,
    /// The architecture.
    pub architecture: String,
    /// The device.
    pub device: String,
    /// A description.
    pub description: String,
    /// True for a software rasterizer.
    pub fallback: bool,
}

/// A request to a page.
#[derive(Debug, Serialize)]
pub struct Request<'l> {
    /// The number of the request, which the answer repeats.
    pub number: u64,
    /// The slots of scenes to forget first.
    pub dropped: Vec<u64>,
    /// The slot of the scene.
    pub slot: u64,
    /// The scene's calls, with empty buffers, if the page does not have them.
    pub list: Option<&'l CallList>,
    /// The indices and lengths of the buffers with contents. The bytes follow the header in this order.
    pub contents: Vec<(usize, usize)>,
    /// The number of frames to draw.
    pub frames: u32,
    /// True if the last frame is read.
    pub read: bool,
}

/// The header of a page's answer. The bytes that were read follow it.
#[derive(Debug, Deserialize)]
pub struct Answer {
    /// The number of the request.
    pub number: u64,
    /// The times of each frame.
    pub times: Vec<PageTimes>,
    /// The failure of the request, if it failed.
    pub error: Option<Failed>,
    /// Uncaptured errors since the last answer.
    pub messages: Vec<String>,
}

/// The times of a frame in milliseconds.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct PageTimes {
    /// Until the work is submitted.
    pub cpu: f64,
    /// Between the GPU timestamps.
    pub gpu: Option<f64>,
    /// Until the device is done.
    pub wall: f64,
}

/// A failure of the device.
#[derive(Debug, Deserialize)]
pub struct Failed {
    /// The kind of the failure.
    pub kind: FailedKind,
    /// The operation that failed.
    pub what: String,
    /// The device's message.
    pub message: String,
}

/// The kind of a failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FailedKind {
    /// The device was lost.
    Lost,
    /// The device refused an object.
    Resource,
    /// The device refused a shader.
    Shader,
    /// Any other failure.
    Internal,
}

impl From<Failed> for BackendError {
    fn from(failed: Failed) -> Self {
        let Failed {
            kind,
            what,
            message,
        } = failed;
        match kind {
            FailedKind::Lost => Self::lost(message),
            FailedKind::Resource => Self::refused(what, message),
            FailedKind::Shader => Self::shader(what, message),
            FailedKind::Internal => Self::internal_of(what, message),
        }
    }
}

/// Takes the contents out of the buffers of a list, and returns their [`Request::contents`] and bytes.
pub fn take_contents(list: &mut CallList) -> (Vec<(usize, usize)>, Vec<Vec<u8>>) {
    let mut contents = Vec::new();
    let mut places = Vec::new();
    for (place, buffer) in list.buffers.iter_mut().enumerate() {
        if !buffer.contents.is_empty() {
            places.push((place, buffer.contents.len()));
            contents.push(std::mem::take(&mut buffer.contents));
        }
    }
    (places, contents)
}

/// Returns a message.
///
/// # Errors
/// If the header is longer than 4 GiB, or has a number that is not finite.
pub fn packed<'b>(
    header: &impl Serialize,
    parts: impl Iterator<Item = &'b [u8]>,
) -> Result<Vec<u8>, String> {
    let header = serde_json::to_vec(header).map_err(|error| error.to_string())?;
    let length = u32::try_from(header.len()).map_err(|_| "the scene is too large".to_owned())?;
    let mut message = length.to_le_bytes().to_vec();
    message.extend(header);
    parts.for_each(|part| message.extend(part));
    Ok(message)
}

/// Returns the header of a message, and the bytes after it.
///
/// # Errors
/// If the bytes are not a message.
pub fn unpacked<T: DeserializeOwned>(message: &[u8]) -> Result<(T, &[u8]), String> {
    let short = || "a message ends in its header".to_owned();
    let (length, rest) = message.split_first_chunk().ok_or_else(short)?;
    let length = u32::from_le_bytes(*length) as usize;
    let (header, bytes) = rest.split_at_checked(length).ok_or_else(short)?;
    let header = serde_json::from_slice(header).map_err(|error| error.to_string())?;
    Ok((header, bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_keeps_its_header_and_its_bytes() {
        let parts: [&[u8]; 2] = [b"ab", b"c"];
        let message = packed(&7, parts.into_iter()).expect("it is packed");
        assert_eq!(unpacked::<u32>(&message), Ok((7, b"abc".as_slice())));
    }

    #[test]
    fn garbage_is_refused() {
        for garbage in [&b""[..], b"\x01\0\0", b"\xff\xff\xff\xff7", b"\x01\0\0\0x"] {
            assert!(unpacked::<u32>(garbage).is_err(), "{garbage:?}");
        }
        let header = r#"{"number":1,"times":[],"error":{"kind":"worse","what":"","message":""},"messages":[]}"#;
        assert!(serde_json::from_str::<Answer>(header).is_err());
    }
}
