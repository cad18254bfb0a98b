//! The protocol between parent and worker: length-prefixed binary messages over two pipes.

use etalon_backend::{BackendError, FrameTime, Recording, Unavailable};
use etalon_frame::{AdapterInfo, Frame, Limits};
use etalon_scene::Scene;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::io::{self, Read, Write};
use std::time::Duration;

#[cfg(test)]
#[path = "../../record/tests/spoil/mod.rs"]
mod spoil;

/// The longest message in bytes; a longer one is garbage.
const MAX_MESSAGE: u32 = 1 << 30;
const _: () = assert!(Scene::MOST_CONTENT < MAX_MESSAGE as u64);

/// A request from the parent. `slot` is the parent's number for a prepared scene.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Request<'s> {
    /// Prepare a scene.
    Prepare { slot: u32, scene: Cow<'s, Scene> },
    /// Draw a prepared scene `times` times.
    Submit { slot: u32, times: u32 },
    /// Read a drawn scene back.
    ReadBack { slot: u32 },
    /// Forget a prepared scene.
    Drop { slot: u32 },
    /// Return the calls of the first scene.
    Recording { slot: u32 },
}

/// An answer from the worker: one per request, in the same order.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Response {
    /// The first message: the adapter, or why it is not available.
    Hello(Result<Box<Hello>, Unavailable>),
    /// The answer to a request.
    Done {
        /// The request's slot.
        slot: u32,
        outcome: Result<Payload, BackendError>,
        /// The time that the worker spent on the request.
        elapsed: Duration,
        /// Messages of validation layers and debug output since the last answer.
        messages: Vec<String>,
    },
}

/// The result of a request.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum Payload {
    Prepared,
    Submitted(Vec<FrameTime>),
    Frame(Box<Frame>),
    Dropped,
    Recording(Option<Box<Recording>>),
}

/// An adapter as its worker describes it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Hello {
    /// The adapter's names and versions.
    pub info: AdapterInfo,
    /// The adapter's limits and features.
    pub limits: Limits,
}

impl Request<'_> {
    /// Returns the slot of the scene that the request is about.
    pub(crate) fn slot(&self) -> u32 {
        match self {
            Self::Prepare { slot, .. }
            | Self::Submit { slot, .. }
            | Self::ReadBack { slot }
            | Self::Drop { slot }
            | Self::Recording { slot } => *slot,
        }
    }
}

/// Returns the bytes of a message in a pipe.
pub(crate) fn encode<T: Serialize>(message: &T) -> io::Result<Vec<u8>> {
    encode_after(Vec::new(), message)
}

/// Appends the bytes of a message to those of earlier messages.
pub(crate) fn encode_after<T: Serialize>(mut bytes: Vec<u8>, message: &T) -> io::Result<Vec<u8>> {
    const LENGTH: usize = size_of::<u32>();
    let start = bytes.len() + LENGTH;
    bytes.resize(start, 0);
    // `to_extend` copies byte by byte.
    let mut bytes = postcard::to_io(message, bytes).map_err(io::Error::other)?;
    let length = u32::try_from(bytes.len() - start)
        .ok()
        .filter(|n| *n <= MAX_MESSAGE)
        .ok_or_else(|| io::Error::other("the message is too long"))?;
    bytes[start - LENGTH..start].copy_from_slice(&length.to_le_bytes());
    Ok(bytes)
}

/// Sends a message at once.
pub(crate) fn send<T: Serialize>(to: &mut impl Write, message: &T) -> io::Result<()> {
    to.write_all(&encode(message)?)?;
    to.flush()
}

/// Returns the next message; `None` if the stream ends between two messages.
pub(crate) fn receive<T: DeserializeOwned>(from: &mut impl Read) -> io::Result<Option<T>> {
    let mut length = [0; 4];
    match from.read(&mut length[..1])? {
        0 => return Ok(None),
        _ => from.read_exact(&mut length[1..])?,
    }
    let length = u32::from_le_bytes(length);
    if length > MAX_MESSAGE {
        return Err(io::Error::other("not a message of the protocol"));
    }
    // The buffer grows while reading, so that a false length cannot allocate much memory.
    let mut bytes = Vec::with_capacity((length as usize).min(1 << 20));
    from.take(u64::from(length)).read_to_end(&mut bytes)?;
    if bytes.len() < length as usize {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    postcard::from_bytes(&bytes)
        .map(Some)
        .map_err(|e| io::Error::other(format!("not a message of the protocol: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_frame::{Aspect, ChannelEncoding, Image, ReadPath, TextureFormat};
    use etalon_scene::{Attachment, AttachmentContents, Path, QueryScope};

    #[test]
    fn messages_survive_the_pipe_and_garbage_is_refused() {
        let mut pipe = Vec::new();
        send(&mut pipe, &Request::Drop { slot: 7 }).expect("sent");
        let mut from = pipe.as_slice();
        let back: Option<Request> = receive(&mut from).expect("received");
        assert!(matches!(back, Some(Request::Drop { slot: 7 })));
        assert!(receive::<Request>(&mut from).expect("end").is_none());
        assert!(receive::<Response>(&mut &b"hello, this is no message"[..]).is_err());
        assert!(receive::<Response>(&mut &[3, 0, 0, 0, 1][..]).is_err());
    }

    #[test]
    fn errors_survive_the_pipe_with_and_without_a_code() {
        let refused = || BackendError::refused("a buffer", "no memory");
        for error in [
            BackendError::lost("gone"),
            refused(),
            refused().with_code("ERROR_OUT_OF_HOST_MEMORY"),
            BackendError::shader("flat_color", "no"),
            BackendError::internal("no frame came back"),
            BackendError::internal_of("drawing", "0x0502").with_code("GL_INVALID_OPERATION"),
        ] {
            let mut pipe = Vec::new();
            send(&mut pipe, &error).expect("sent");
            let back: Option<BackendError> = receive(&mut pipe.as_slice()).expect("received");
            assert_eq!(back, Some(error));
        }
    }

    #[test]
    fn a_scene_takes_no_more_bytes_than_its_content_and_some_for_its_states() {
        let scene = Scene {
            attachments: vec![Attachment {
                name: "texture".to_owned(),
                format: TextureFormat::Rgba32Float,
                size: [64, 64],
                samples: 1,
                contents: AttachmentContents::Texels(vec![0.7_f32.to_bits(); 64 * 64 * 4]),
            }],
            passes: Vec::new(),
            read: Vec::new(),
            counters: Vec::new(),
            query_scope: QueryScope::default(),
            pool: None,
            path: Path::default(),
        };
        let content = scene.content_bytes();
        let scene = Cow::Owned(scene);
        let sent = encode(&Request::Prepare { slot: 0, scene }).expect("encoded");
        assert!((content..content + 100).contains(&(sent.len() as u64)));
    }

    #[test]
    fn no_message_panics_or_hangs_a_reader() {
        let frame = Frame {
            images: vec![image(vec![0, 256, 7]), image(vec![1])],
            counters: vec![1, u64::MAX],
        };
        let done = |outcome| Response::Done {
            slot: 1,
            outcome,
            elapsed: Duration::from_millis(1),
            messages: vec!["a message".to_owned()],
        };
        let answers = [
            done(Ok(Payload::Frame(Box::new(frame)))),
            done(Ok(Payload::Submitted(Vec::new()))),
            done(Err(BackendError::refused("a buffer", "no memory"))),
        ];
        let mut corpus: Vec<Vec<u8>> = answers
            .iter()
            .map(|answer| encode(answer).expect("encoded"))
            .collect();
        corpus.push(encode(&Request::Submit { slot: 1, times: 2 }).expect("encoded"));
        let corpus: Vec<&[u8]> = corpus.iter().map(Vec::as_slice).collect();
        spoil::keep_trying("messages", &corpus, |input| {
            let _ = receive::<Response>(&mut &*input);
            let _ = receive::<Request>(&mut &*input);
        });
    }

    fn image(codes: Vec<u32>) -> Image {
        Image {
            attachment: "color".to_owned(),
            aspect: Aspect::Color,
            size: [codes.len() as u32, 1],
            samples: 1,
            channels: vec![ChannelEncoding::Unorm(8)],
            read: ReadPath::Copy,
            codes,
        }
    }

    #[test]
    fn codes_of_any_width_survive_the_pipe() {
        for codes in [
            vec![],
            vec![0, 255],
            vec![0, 256, 0xffff],
            vec![7, 0x1_0000, u32::MAX],
        ] {
            let sent = image(codes);
            let mut pipe = Vec::new();
            send(&mut pipe, &sent).expect("sent");
            let back: Option<Image> = receive(&mut pipe.as_slice()).expect("received");
            assert_eq!(back, Some(sent));
        }
    }

    #[test]
    fn codes_of_an_unknown_width_and_parts_of_codes_are_refused() {
        let bytes = encode(&image(vec![0, 256])).expect("encoded");
        let width = bytes.len() - 5;
        assert_eq!(bytes[width..], [2, 0, 0, 0, 1]);
        for wrong in [0, 3, 5] {
            let mut bytes = bytes.clone();
            bytes[width] = wrong;
            assert!(receive::<Image>(&mut bytes.as_slice()).is_err(), "{wrong}");
        }
        // The length of the codes comes before their width; the last code loses a byte.
        let mut cut = bytes;
        cut[width - 1] -= 1;
        cut[0] -= 1;
        cut.pop();
        assert!(receive::<Image>(&mut cut.as_slice()).is_err());
    }
}
