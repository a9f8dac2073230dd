(()=>{var qi=[.3,1.6,3.4,5.5,8,10.8,13.9,17.2,20.8,24.5,28.5,32.7],Gi=["calm","light air","light breeze","gentle breeze","moderate breeze","fresh breeze","strong breeze","near gale","gale","strong gale","storm","violent storm","hurricane"],Hi=[0,.1,.5,1.25,2.5,4,6,9,14],ji=["glassy","rippled","smooth","slight","moderate","rough","very rough","high","very high","phenomenal"],Vi=["east","east-north-east","north-east","north-north-east","north","north-north-west","north-west","west-north-west","west","west-south-west","south-west","south-south-west","south","south-south-east","south-east","east-south-east"];function Wi(s){let t=qi.filter(e=>s>=e).length;return{number:t,name:Gi[t]}}function Xi(s){let t=Hi.filter(e=>s>e).length;return{number:t,name:ji[t]}}function Qe(s){let t=Math.round(s/22.5);return Vi[(t%16+16)%16]}function Yi(s){return String(Number(s<10?s.toPrecision(2):s.toFixed(0)))}function pt(s,t){let e=Yi(s);return`${e} ${t}${e==="1"?"":"s"}`}function C(s){return typeof s=="number"&&Number.isFinite(s)}function Ki(s){let{hs:t,tp:e,direction:i}=s;if(!C(t))return"A sea.";if(t<.005)return"A flat sea without waves.";let o=[`A ${Xi(t).name} sea`,`significant wave height ${pt(t,"metre")}`];return C(e)&&o.push(`peak period ${pt(e,"second")}`),C(i)&&o.push(`running toward the ${Qe(i)}`),`${o.join(", ")}.`}function Qi(s){let t=s?.speed;if(!C(t))return"";let{number:e,name:i}=Wi(t),o=C(s.direction)?` toward the ${Qe(s.direction)}`:"";return`Wind of ${pt(t,"metre")} per second${o}, Beaufort ${e}, ${i}.`}function Ji(s){if(!C(s?.sunElevation))return"";let t=Math.round(s.sunElevation);return t<0?"The sun is below the horizon.":`The sun stands ${t} degree${t===1?"":"s"} above the horizon.`}function Je({document:s,look:t,paused:e,few:i,playback:o}){let n=s?.statistics?.realised??s?.statistics?.specified??{},r=C(s?.depth)&&s.depth<1e6?`The water is ${pt(s.depth,"metre")} deep.`:"";return[o?"A recorded sea is played.":"",Ki(n),Qi(s?.wind),r,Ji(t),i?"Few waves are shown beside the sea of the same spectrum.":"",e?"Time stands still.":""].filter(Boolean).join(" ")}function Ze(s=globalThis){return s.matchMedia?.("(prefers-reduced-motion: reduce)").matches??!1}var mt=class{constructor(t,e=1.2){this.region=t,this.rest=e,this.timer=null,this.said=""}say(t){clearTimeout(this.timer),t!==this.said&&(this.timer=setTimeout(()=>this.sayNow(t),1e3*this.rest))}sayNow(t){clearTimeout(this.timer),this.said=t,this.region.textContent=t}dispose(){clearTimeout(this.timer)}};var N=Math.PI/180,Zi=6371e3,gt=.15,vt=2e5,ts=48,xt=class{constructor({east:t=0,north:e=0,height:i=6,yaw:o=60,pitch:n=-6,fieldOfView:r=50}={}){Object.assign(this,{east:t,north:e,height:i,yaw:o,pitch:n,fieldOfView:r})}axes(){let[t,e]=[Math.cos(this.yaw*N),Math.sin(this.yaw*N)],[i,o]=[Math.cos(this.pitch*N),Math.sin(this.pitch*N)];return{right:[e,-t,0],up:[-o*t,-o*e,i],forward:[i*t,i*e,o]}}matrices(t){let{right:e,up:i,forward:o}=this.axes(),n=Math.tan(this.fieldOfView*N/2),[r,a]=[1/(n*t),1/n],c=-(vt+gt)/(vt-gt),l=-2*vt*gt/(vt-gt),h=new Float32Array(16);for(let f=0;f<3;f++){let m=[r*e[f],a*i[f],-c*o[f],o[f]];h.set(m,4*f)}h[14]=l;let u=Float32Array.from([...e.map(f=>f*n*t),...i.map(f=>f*n),...o]);return{viewProjection:h,rays:u}}move(t,e=0,i=0){let[o,n]=[Math.cos(this.yaw*N),Math.sin(this.yaw*N)];this.east+=t*o+e*n,this.north+=t*n-e*o,this.height=Math.min(Math.max(this.height+i,.3),2e4)}turn(t,e=0){this.yaw=((this.yaw+t)%360+360)%360,this.pitch=Math.min(Math.max(this.pitch+e,-90),90)}};function to(s){return Math.sqrt(2*Zi*Math.max(s,0))}function eo(s,t){let{rays:e}=s.matrices(t),i=[[-1,-1],[1,-1],[1,1],[-1,1]],o=[];return i.forEach(([n,r],a)=>{let[c,l]=i[(a+1)%4];for(let h=0;h<ts;h++){let u=h/ts,[f,m]=[n+u*(c-n),r+u*(l-r)],p=[0,1,2].map(v=>f*e[v]+m*e[3+v]+e[6+v]),g=Math.hypot(...p);o.push(p.map(v=>v/g))}}),o}function es(s,t,e,i=1.15){let{right:o,up:n,forward:r}=s.axes(),a=h=>h.reduce((u,f,m)=>u+f*e[m],0),c=a(r),l=Math.tan(s.fieldOfView*N/2)*i;return c>0&&Math.abs(a(n))<=l*c&&Math.abs(a(o))<=l*t*c}function wt(s,t,e){let i=s.height,o=Math.max(s.height,e)+1,n=to(o),r=eo(s,t),a=s.yaw*N,c=es(s,t,[0,0,-1])||es(s,t,[0,0,1]),l=0,h=n,u=0;for(let[m,p,g]of r){let v=m*Math.cos(a)+p*Math.sin(a),w=p*Math.cos(a)-m*Math.sin(a);l=Math.max(l,Math.abs(Math.atan2(w,v)));let x=Math.hypot(m,p);i<=e?h=0:g<0&&(h=Math.min(h,(i-e)*x/-g));let y=-g>4*o*x/n;u=Math.max(u,y?(o+e)*x/-g+e:n)}if(u=Math.min(Math.max(u,4*e),n),c||l>1.4)return{apex:0,middle:a,half:Math.PI,near:0,far:u};l+=.01;let f=e/Math.sin(l);return{apex:f,middle:a,half:l,near:Math.max(h-e,-f),far:u}}function yt(s,t,e,i,o=1.3){let n=Math.max(.6*e,.8),r=g=>(g*g+n*n)**(-o/2),a=16*i,[c,l]=[Math.asinh(s/n),Math.asinh(t/n)],h=Array.from({length:a+1},(g,v)=>n*Math.sinh(c+(l-c)*v/a)),u=[0];for(let g=1;g<=a;g++){let v=.5*(h[g]+h[g-1]);u.push(u[g-1]+r(v)*(h[g]-h[g-1]))}let f=u[a],m=new Float32Array(2*i),p=1;for(let g=0;g<i;g++){let v=f*g/(i-1);for(;p<a&&u[p]<v;)p++;let w=Math.min((v-u[p-1])/(u[p]-u[p-1]),1),x=h[p-1]+w*(h[p]-h[p-1]);m[2*g]=x,m[2*g+1]=f/(i-1)/r(x)}return m}var bt=class{constructor({loop:t,ticks:e}){this.loop=t,this.ticks=e,this.scale=1,this.paused=!1,this.position=0,this.last=null}get tick(){return Math.floor(this.position)>>>0}set tick(t){this.position=oe(t,this.ticks)}get seconds(){return this.tick*this.loop/this.ticks}update(t){let e=this.last===null?0:(t-this.last)/1e3;return this.last=t,this.paused?0:this.advance(e*this.scale)}advance(t){let e=t%this.loop/this.loop;return this.position=oe(this.position+e*this.ticks,this.ticks),t}follow({loop:t,ticks:e}){if(t===this.loop&&e===this.ticks)return;let i=this.position*this.loop/this.ticks;Object.assign(this,{loop:t,ticks:e}),this.position=oe(i/t*e,e)}};function oe(s,t){let e=s%t,i=e<0?e+t:e;return i<t?i:0}var L=["displace_x","displace_y","height","stretch_xy","slope_x","slope_y","stretch_xx","stretch_yy"];function so(s){return Math.ceil(s/16)*16}function io(s){return ArrayBuffer.isView(s)?new Uint8Array(s.buffer,s.byteOffset,s.byteLength):new Uint8Array(s)}function _t(s,t){let e=io(s),i=new DataView(e.buffer,e.byteOffset,e.byteLength),o=String.fromCharCode(...e.subarray(0,4));if(e.length<16||o!==t)throw new Error(`the data must begin with ${t}, got ${JSON.stringify(o)}`);let n=i.getUint32(4,!0);if(n!==1)throw new Error(`version of the data must be 1, got ${n}`);let r=i.getUint32(8,!0);if(16+r>e.length)throw new Error(`the header must end within the data: ${r} of ${e.length} bytes`);let a=new TextDecoder().decode(e.subarray(16,16+r));return{header:JSON.parse(a),rest:e.subarray(16+r)}}function oo(s,t){let e=new Map,i=0;for(let{name:o,bytes:n}of s.files){if(i+n>t.length)throw new Error(`the data ends within ${o}`);e.set(o,t.subarray(i,i+n)),i+=so(n)}return e}function no(s,t){return s.has(t)?JSON.parse(new TextDecoder().decode(s.get(t))):null}function ne(s){let{header:t,rest:e}=_t(s,"FFTO");if(t.format!=="fftocean-runtime"||t.version!==1)throw new Error(`the format must be fftocean-runtime 1, got ${t.format} ${t.version}`);q("ticks",t.ticks);let i=oo(t,e),o=t.tiles.map((n,r)=>{let a=i.get(`tile${r}.waves`);if(!a)throw new Error(`the file tile${r}.waves is missing`);return ro(n,a,t.depth??1/0)});return{document:t,tiles:o,reference:no(i,"check.json")}}function q(s,t){let e=Math.ceil(Math.log2(t));if(!(t>=2)||2**e!==t){let i=t>=2?2**e:2;throw new Error(`${s} must be a power of two, got ${t}: the next one is ${i}`)}}function ro(s,t,e){let[i,o]=s.n,[n,r]=s.size;if(q("n",i),q("n",o),t.length%14)throw new Error(`waves must be records of 14 bytes, got ${t.length} bytes`);let a=new Float32Array(4*i*o),c=lo(i,o,n,r,e).slice(),l=new DataView(t.buffer,t.byteOffset,t.byteLength),h=new Float64Array(8);for(let u=0;u<t.length;u+=14){let f=l.getInt16(u,!0),m=l.getInt16(u+2,!0);if(2*Math.abs(f)>=i||2*Math.abs(m)>=o)throw new Error(`a wave must have |mx| < ${i/2} and |my| < ${o/2}, got (${f}, ${m})`);let p=(m&o-1)*i+(f&i-1),g=(-m&o-1)*i+(-f&i-1),v=l.getFloat32(u+6,!0),w=l.getFloat32(u+10,!0);a[4*p]=v,a[4*p+1]=w,a[4*g+2]=v,a[4*g+3]=-w,c[2*p]=c[2*g]=l.getUint16(u+4,!0),ao(h,f/n,m/r,v*v+w*w,c[2*p+1])}return{nx:i,ny:o,lx:n,ly:r,lifts:co(h),h0:a,wave:c}}function ao(s,t,e,i,o){let[n,r]=[(2*Math.PI*t)**2,(2*Math.PI*e)**2],a=i*o*o;s[0]+=a*n,s[1]+=a*r,s[2]+=i,s[3]+=a*n*r,s[4]+=i*n,s[5]+=i*r,s[6]+=a*n*n,s[7]+=a*r*r}function co(s){return[0,2,4,6].map(t=>{let e=Math.round(Math.log2(s[t]/s[t+1])/2)||0;return 2**Math.min(Math.max(e,-40),40)})}var Y=new Map;function lo(s,t,e,i,o){let n=[s,t,e,i,o].join();if(Y.has(n))return Y.get(n);let r=new Float32Array(2*s*t);for(let a=0;a<t;a++){let c=2*Math.PI*(2*a<t?a:a-t)/i;for(let l=0;l<s;l++){let h=2*Math.PI*(2*l<s?l:l-s)/e,u=Math.sqrt(h*h+c*c);u>0&&(r[2*(a*s+l)+1]=1/(u*Math.tanh(u*o)))}}return Y.size>=16&&Y.clear(),Y.set(n,r),r}function ss(s){let{header:t,rest:e}=_t(s,"FFTR"),i=t.nx*t.ny;if(e.length<4*i*t.fields.length)throw new Error(`a reference must hold ${t.fields.length} fields of ${i} numbers, got ${e.length} bytes`);let o=new Float32Array(e.slice(0,4*i*t.fields.length).buffer),n={};return t.fields.forEach((r,a)=>{n[r]=o.subarray(a*i,(a+1)*i)}),{header:t,fields:n}}var is=0;function k(s){return is+=1,`fftocean-${s}-${is}`}function d(s,t={},...e){let i=document.createElement(s),{text:o,on:n={},...r}=t;for(let[a,c]of Object.entries(r))c==null||c===!1||i.setAttribute(a,c===!0?"":String(c));o!==void 0&&(i.textContent=o);for(let[a,c]of Object.entries(n))i.addEventListener(a,c);return i.append(...e.filter(a=>a!=null)),i}var os="http://www.w3.org/2000/svg";function Et(s){let t=document.createElementNS(os,"svg"),e=document.createElementNS(os,"path");return t.setAttribute("viewBox","0 0 24 24"),t.setAttribute("aria-hidden","true"),t.setAttribute("class","icon"),e.setAttribute("d",s),t.append(e),t}function K(s){return s.slice(0,1).toUpperCase()+s.slice(1)}var ho={"-":"",degrees:"°","mg/m^3":"mg/m³"},uo=1e5;function fo({unit:s="",high:t}){return s==="m"&&t>=uo?{unit:"km",size:1e3}:{unit:ho[s]??s,size:1}}function po(s){let t=s.kind??(s.choices?"choice":s.unit===void 0?"switch":"number");return Object.freeze({name:s.name,label:K(s.label??s.name),...fo(s),help:s.help??"",group:s.group??"Other",low:s.low??0,high:s.high??1,step:s.step??0,default:s.default??null,keyDown:s.key_down??null,keyUp:s.key_up??null,logarithmic:!!s.logarithmic,local:!!s.local,wraps:!!s.wraps,whole:!!s.whole,infinite:s.infinite??null,kind:t,choices:s.choices?Object.freeze([...s.choices]):null})}function ns(s){return{parameters:s.parameters.map(po),actions:s.actions??[],presets:s.presets??[]}}function rs(s){return Object.fromEntries(s.map(t=>[t.name,t.default]))}function as(s){return s.logarithmic||(s.high-s.low)/(s.step||1)<=1e5}function cs(s){if(!(s>0))return 2;let[,t=""]=String(s).split(".");return t.length}function re(s,t){if(s.logarithmic){let i=Math.min(s.high,Math.max(s.low,t));return i===s.low||i===s.high?i:Number(i.toPrecision(3))}let e=t;return s.step>0&&(e=s.low+Math.round((e-s.low)/s.step)*s.step),e=Math.min(s.high,Math.max(s.low,e)),Number(e.toFixed(cs(s.step)))}function mo(s,t){let e=s.whole?s.high-s.low+s.step:s.high-s.low;return s.low+((t-s.low)%e+e)%e}function Tt(s,t,e){if(s.kind==="switch")return!t;if(s.kind==="choice"){let n=s.choices.length,r=s.choices.indexOf(t)+e,a=s.wraps?(r+n)%n:Math.min(n-1,Math.max(0,r));return s.choices[a]}if(s.infinite&&t===null)return e<0?s.high:null;if(s.logarithmic)return s.infinite&&e>0&&t>=s.high?null:re(s,t*s.step**e);let i=t+e*(s.step||(s.high-s.low)/100),o=i>s.high+1e-9||i<s.low-1e-9;return re(s,s.wraps&&o?mo(s,i):i)}function ls(s,t){if(t===null)return 1e3;let e=Math.min(s.high,Math.max(s.low,Number(t))),o=(s.logarithmic?Math.log(e/s.low)/Math.log(s.high/s.low):(e-s.low)/(s.high-s.low))*1e3;return s.infinite?Math.min(999,Math.round(o)):Math.round(o)}function hs(s,t){if(s.infinite&&t>=1e3)return null;let e=t/1e3,i=s.logarithmic?s.low*(s.high/s.low)**e:s.low+e*(s.high-s.low);return re(s,i)}function O(s,t){if(t===null)return s.infinite?"∞":"";if(t===void 0)return"";let e=Number(t)/s.size;return s.logarithmic?String(Number(e.toPrecision(3))):String(Number(e.toFixed(Math.max(2,cs(s.step)))))}function go(s,t){return t?t==="°"?`${s}°`:`${s} ${t}`:s}function Q(s,t){return s.kind==="choice"?String(t):s.kind==="switch"?t?"on":"off":s.infinite&&t===null?s.infinite:go(O(s,t),s.unit)}function us(s,t){let e=t.trim().toLowerCase();if(s.infinite&&["∞","inf","infinity","deep",s.infinite].includes(e))return null;let i=Number(e.replace(",",".").replace("−","-"))*s.size;if(!(e===""||!Number.isFinite(i))&&!(i<s.low||i>s.high)&&!(s.whole&&!Number.isInteger(i)))return i}function St(s){let t=s.whole?"a whole number from ":"",e=`${O(s,s.low)} to ${Q(s,s.high)}`;return`${t}${e}${s.infinite?", or deep":""}`}function fs(s){let t=new Map;for(let e of s)t.has(e.group)||t.set(e.group,[]),t.get(e.group).push(e);return[...t].map(([e,i])=>({title:e,rows:i}))}var vo=.6,xo={" ":"Space",ArrowLeft:"←",ArrowRight:"→",ArrowUp:"↑",ArrowDown:"↓"};function J(s){return xo[s]??s.toUpperCase()}function wo(s){return fs(s).map(({title:t,rows:e})=>({title:t,controls:e.map(i=>({row:i,label:i.label,unit:i.unit,range:i.kind==="number"?[O(i,i.low),i.infinite?"∞":O(i,i.high)]:null,slider:i.kind==="number"&&as(i),keys:[i.keyDown,i.keyUp].filter(Boolean).map(J)}))}))}var Mt=class{constructor(t,e,{onChange:i,open:o=[]}){this.onChange=i,this.controls=new Map,this.sections=[];for(let{title:n,controls:r}of wo(e)){let a=d("div",{class:"group-body"});for(let l of r){let h=yo(l,u=>this.changed(l.row,u));this.controls.set(l.row.name,h),a.append(h.node)}let c=d("details",{class:"group",open:o.includes(n)},d("summary",{text:n}),a);this.sections.push(c),t.append(c)}}changed(t,e){let i=this.controls.get(t.name);i.touched=performance.now()/1e3,i.fault(""),this.onChange({[t.name]:e})}show(t,{force:e=!1}={}){let i=performance.now()/1e3;for(let[o,n]of Object.entries(t)){let r=this.controls.get(o);r&&(!e&&i-r.touched<vo||r.show(n))}}refuse(t,e){let i=this.controls.get(t);return i?.fault(e),!!i}keepOnly(t){for(let[e,i]of this.controls)i.node.hidden=!t.has(e);for(let e of this.sections)e.hidden=[...e.querySelectorAll(".control")].every(i=>i.hidden)}};function yo(s,t){return{touched:-1/0,...{number:bo,choice:Mo,switch:Ao}[s.row.kind](s,t)}}function ds(s){return d("span",{class:"keys"},...s.map(t=>d("kbd",{text:t})))}function ce(s){let t=k("fault"),e=d("p",{class:"fault",id:t,hidden:!0});return{node:e,fault:o=>{e.textContent=o,e.hidden=!o,o?(s.setAttribute("aria-invalid","true"),s.setAttribute("aria-describedby",t)):(s.removeAttribute("aria-invalid"),s.removeAttribute("aria-describedby"))}}}function bo(s,t){let{row:e,label:i,unit:o,keys:n}=s,r=k("field"),a=k("label"),c=d("input",{id:r,type:"text",inputmode:"decimal",class:"number",autocomplete:"off",spellcheck:"false",title:St(e)}),{node:l,fault:h}=ce(c),{node:u,show:f}=s.slider?_o(s,a,x=>g(x)):Eo(s,()=>g(Tt(e,m,1))),m=e.default,p=x=>{m=x,f(x),document.activeElement!==c&&(c.value=O(e,x))},g=x=>{h(""),p(x),t(x)},v=()=>{let x=us(e,c.value);if(x!==void 0){x!==m&&g(x);return}h(`${i} must be ${St(e)}, got ${c.value.trim()||"nothing"}`)};return c.addEventListener("change",v),c.addEventListener("blur",()=>{c.hasAttribute("aria-invalid")||(c.value=O(e,m))}),c.addEventListener("keydown",x=>{x.key==="Enter"&&v(),x.key==="Escape"&&(h(""),c.value=O(e,m))}),{node:d("div",{class:"control",title:K(e.help)},d("div",{class:"control-head"},d("label",{for:r,id:a,text:i}),ds(n),d("span",{class:"value"},c,o?d("span",{class:"unit",text:o}):null)),u,l),show:p,fault:h}}function _o({row:s,range:t},e,i){let o=d("input",{type:"range",min:0,max:1e3,step:To(s),"aria-labelledby":e}),n=a=>{let c=ls(s,a);o.value=String(c),o.style.setProperty("--share",String(c/1e3)),o.setAttribute("aria-valuetext",Q(s,a))};return o.addEventListener("input",()=>i(hs(s,Number(o.value)))),o.addEventListener("pointerup",()=>o.blur()),{node:d("div",{class:"slider-line"},d("span",{class:"end","aria-hidden":"true",text:t[0]}),o,d("span",{class:"end","aria-hidden":"true",text:t[1]})),show:n}}function Eo({label:s,row:t},e){return{node:d("button",{type:"button",class:"quiet",text:`Next ${s.toLowerCase()}`,title:`${St(t)}`,on:{click:e}}),show:()=>{}}}function To(s){if(s.logarithmic||!(s.step>0))return 1;let t=s.step/(s.high-s.low)*1e3;return t>=1&&Number.isInteger(t)?t:"any"}var So={fft:"FFT",pms:"PMS",cwr:"CWR"};function At(s){return So[s]??K(s)}function ps({row:s,label:t,keys:e},i,o){return d("div",{class:"control",title:K(s.help)},d("div",{class:"control-head"},d("label",{for:i.id,text:t}),ds(e),i),o)}function Mo(s,t){let e=k("field"),i=d("select",{id:e},...s.row.choices.map(a=>d("option",{value:a,text:At(a)}))),{node:o,fault:n}=ce(i);i.addEventListener("change",()=>t(i.value));let r=a=>{i.value=a};return{node:ps(s,i,o),show:r,fault:n}}function Ao(s,t){let e=k("field"),i=d("input",{id:e,type:"checkbox",role:"switch"}),{node:o,fault:n}=ce(i);i.addEventListener("change",()=>t(i.checked));let r=a=>{i.checked=!!a};return{node:ps(s,i,o),show:r,fault:n}}function ms(s,t){if(!s.length)return null;let e=k("field"),i=d("select",{id:e},d("option",{value:"",text:"Choose …"})),o=new Map;return s.forEach((r,a)=>{let c=r.scale??r.group??"Seas";o.has(c)||o.set(c,d("optgroup",{label:c})),o.get(c).append(d("option",{value:a,text:r.label??r.name}))}),i.append(...o.values()),i.addEventListener("change",()=>{i.value!==""&&t(s[Number(i.value)])}),{node:d("div",{class:"control preset"},d("div",{class:"control-head"},d("label",{for:e,text:"Preset"}),i)),clear:()=>i.value=""}}function ko(s){let t="";for(let e=0;e<s.length;e+=8192)t+=String.fromCharCode(...s.subarray(e,e+8192));return btoa(t)}function le(s,t){if(t.length===0)return{refused:`the file ${s} is empty`};if(t.length>48128)return{refused:`a file must have at most 47 KiB, got ${(t.length/1024).toFixed(0)} KiB: ${s}`};if(/\.toml$/i.test(s))try{return{message:{job:new TextDecoder("utf-8",{fatal:!0}).decode(t)}}}catch{return{refused:`a job must be UTF-8 text: ${s}`}}return{message:{file:{name:s,base64:ko(t)}}}}function gs(s,{onFile:t,onRefused:e,onOver:i,signal:o}){let n={signal:o},r=0;s.addEventListener("dragenter",a=>{a.preventDefault(),r+=1,i(!0)},n),s.addEventListener("dragover",a=>a.preventDefault(),n),s.addEventListener("dragleave",()=>{r=Math.max(0,r-1),r||i(!1)},n),s.addEventListener("drop",async a=>{a.preventDefault(),r=0,i(!1);let c=[...a.dataTransfer?.files??[]];if(c.length!==1){e(`drop one file, got ${c.length}`);return}await he(c[0],{onFile:t,onRefused:e})},n)}async function he(s,{onFile:t,onRefused:e}){if(s.size>48128){e(le(s.name,{length:s.size}).refused);return}try{t(s.name,new Uint8Array(await s.arrayBuffer()))}catch(i){e(`the file ${s.name} cannot be read: ${i.message}`)}}var vs=5e-7,ue="–",xs=12,Ro=["Waves","Frames","Tiles","Seed","Loop","Tick","Picture","Connection","Made by"];function G(s,t){return typeof s=="number"&&Number.isFinite(s)?s.toFixed(t):ue}function Fo(s){if(typeof s!="number"||!Number.isFinite(s))return ue;let t=((Math.round(s)+180)%360+360)%360-180;return`${t===-180?180:t}°`}function ws(s){let{specified:t,realised:e}=s.statistics??{};return{specified:t??{},realised:e??{}}}function fe({hs:s,tp:t}){return s===0||t===0}function ys(s){let{tp:t,direction:e}=fe(s)?{}:s;return{tp:t,direction:e}}function Io(s){let{specified:t,realised:e}=ws(s),i=[t,e].map(ys);return[["Hs [m]",G(t.hs,2),G(e.hs,2)],["Tp [s]",...i.map(({tp:o})=>G(o,1))],["Direction",...i.map(({direction:o})=>Fo(o))]]}function No(s){let t=({n:[o,n]})=>o===n?`${o}²`:`${o} × ${n}`,e=({size:o})=>String(Number(o[0].toPrecision(3))),i=new Map;for(let o of s)i.has(t(o))||i.set(t(o),[]),i.get(t(o)).push(e(o));return[...i].map(([o,n])=>`${o} on ${n.join(", ")} m`).join("; ")}function de({tiles:s}){return s.reduce((t,e)=>t+(e.waves??0),0)}function Z(s){return String(Math.round(s)).replace(/\B(?=(\d{3})+$)/g," ")}function pe(s){return`${Z(s)} ${s===1?"wave":"waves"}`}function Lo(s){return Number.isFinite(s)?s.toExponential(1):"not a number"}var kt=class{constructor(){this.times=[]}note(t){for(this.times.push(t);this.times.length>2&&t-this.times[0]>1;)this.times.shift();let e=t-this.times[0];return e>0?(this.times.length-1)/e:null}clear(){this.times=[]}},Rt=class{constructor({chip:t,body:e}){this.cells={},this.body=e;let i=(o,n={})=>(this.cells[o]=d("span",n),this.cells[o]);t.append(i("dot",{class:"dot","aria-hidden":"true"}),i("hs",{class:"figure"}),i("tp",{class:"figure"}),i("rate",{class:"figure"}),i("quality",{class:"badge"})),this.table=d("tbody"),this.plot=d("canvas",{class:"plot",role:"img","aria-label":"The spectrum by frequency and by direction, specified beside realised"}),this.list=d("dl",{class:"facts"}),this.notes=d("div",{class:"notes"}),this.verification=d("div",{class:"verification",role:"status"}),this.source=d("p",{class:"source"}),this.sentence=d("p",{class:"sentence"}),this.words=d("details",{class:"words"},d("summary",{text:"In words"}),this.sentence),e.append(this.source,d("table",{class:"statistics"},d("thead",{},d("tr",{},d("td",{}),d("th",{scope:"col",class:"specified",text:"Specified"}),d("th",{scope:"col",class:"realised",text:"Realised"}))),this.table),this.plot,this.list,this.words,this.notes,this.verification),this.facts=new Map;for(let o of Ro)this.fact(o,"")}showSea(t,{source:e,quality:i,sentence:o}){this.table.replaceChildren(...Io(t).map(([u,f,m])=>d("tr",{},d("th",{scope:"row",text:u}),d("td",{text:f}),d("td",{text:m}))));let{specified:n,realised:r}=ws(t);this.text("hs",`Hs ${G(r.hs??n.hs,2)} m`);let{tp:a}=ys(r.hs===void 0?n:r);this.text("tp",`Tp ${G(a,1)} s`),this.showQuality(i),this.source.textContent=e??"",this.source.hidden=!e,this.sentence.textContent=o;let{tiles:c}=t,{frames:l}=t,h=l&&Number((l/t.loop).toPrecision(3));this.fact("Waves",l?"":Z(de(t))),this.fact("Frames",l?`${Z(l)}, ${h} a second`:""),this.fact("Tiles",No(c)),this.fact("Loop",`${Number(t.loop.toPrecision(6))} s`),Number.isFinite(c[0]?.seed)&&this.fact("Seed",String(c[0].seed))}showQuality(t){this.text("quality",t??""),this.cells.quality.dataset.quality=t??""}showNotes(t){this.notes.replaceChildren(...t.map(e=>d("p",{class:"note",text:e})))}showTime({rate:t,tick:e,ticks:i,paused:o,picture:n}){let r=o?"paused":t===null?"":`${G(t,t<10?1:0)} fps`;this.text("rate",r),this.fact("Tick",`${Z(e)} of ${Z(i)}`),this.fact("Picture",n)}showConnection(t,e){this.cells.dot.dataset.phase=t,this.fact("Connection",e)}showVerification({title:t,rows:e,note:i=""}){let o=[...new Set(e.map(c=>c.field))],n=[...new Set(e.map(c=>c.tile))],r=(c,l)=>e.find(h=>h.tile===c&&h.field===l),a=e.length>0&&e.every(c=>c.error<=vs);this.verification.dataset.passed=e.length?String(a):"",this.verification.replaceChildren(d("p",{class:"verdict",text:t}),...e.length?[d("table",{class:"errors"},d("caption",{text:"Relative error of each field"}),d("thead",{},d("tr",{},d("td",{}),...n.map(c=>d("th",{scope:"col",text:`tile ${c}`})))),d("tbody",{},...o.map(c=>d("tr",{},d("th",{scope:"row",text:c.replaceAll("_"," ")}),...n.map(l=>{let h=r(l,c)?.error;return d("td",{class:h<=vs?"good":"bad",text:h===void 0?ue:Lo(h)})})))))]:[],...i?[d("p",{class:"note",text:i})]:[])}revealVerification(){let t=this.body.getBoundingClientRect(),e=this.verification.getBoundingClientRect(),i=e.bottom-t.bottom+xs;i>0&&(this.body.scrollTop+=Math.min(i,e.top-t.top-xs))}text(t,e){this.cells[t].textContent!==e&&(this.cells[t].textContent=e)}fact(t,e){let i=this.facts.get(t);i||(i=d("dd",{hidden:!0}),this.facts.set(t,i),this.list.append(d("dt",{text:t,hidden:!0}),i)),i.textContent!==e&&(i.textContent=e,i.hidden=i.previousSibling.hidden=!e)}};function Oo(s,t){return(3+1.2*s)*(t?4:1)}function bs(s,t,e){if(!t.any)return!1;let i=Oo(s.height,t.fast)*e;s.move(t.axis("forward","back")*i,t.axis("right","left")*i,t.axis("up","down")*i*.5);let o=45*e*(t.fast?2:1);return s.turn(t.axis("turn_left","turn_right")*o,t.axis("look_up","look_down")*o),!0}function me(s,t,{onMove:e,signal:i}){let o={signal:i},n=new Map,r=()=>{let[c,l]=[...n.values()];return Math.hypot(c.x-l.x,c.y-l.y)},a=c=>{t.move(c*(4+t.height)),e()};s.addEventListener("pointerdown",c=>{s.setPointerCapture?.(c.pointerId),n.set(c.pointerId,{x:c.clientX,y:c.clientY}),s.classList.add("dragged")},o),s.addEventListener("pointermove",c=>{let l=n.get(c.pointerId);if(!l)return;let h={x:c.clientX,y:c.clientY};if(n.size===2){let f=r();n.set(c.pointerId,h),a(2*Math.log(r()/Math.max(f,1)));return}n.set(c.pointerId,h);let u=t.fieldOfView/Math.max(s.clientHeight,1);t.turn((h.x-l.x)*u,(h.y-l.y)*u),e()},o);for(let c of["pointerup","pointercancel"])s.addEventListener(c,l=>{n.delete(l.pointerId),n.size||s.classList.remove("dragged")},o);s.addEventListener("wheel",c=>{c.preventDefault();let l=c.deltaMode===0?c.deltaY/100:c.deltaY/3;a(-.25*Math.max(-3,Math.min(3,l)))},{...o,passive:!1})}var $o=Object.freeze([{name:"turn_left",key:"ArrowLeft",label:"turn left",held:!0},{name:"turn_right",key:"ArrowRight",label:"turn right",held:!0},{name:"look_up",key:"ArrowUp",label:"look up",held:!0},{name:"look_down",key:"ArrowDown",label:"look down",held:!0}]),Po=new Set(["INPUT","TEXTAREA","SELECT"]),zo=new Set(["BUTTON","SUMMARY","A"]);function _s(s){return s.length===1?s.toLowerCase():s}function It(s){return!!s&&(Po.has(s.tagName)||s.isContentEditable===!0)}function ge(s){return[...s,...$o]}function Es(s,t){let e=new Map;for(let{name:i,keyDown:o,keyUp:n}of s)o&&e.set(o,{type:"step",name:i,direction:-1,ring:!1}),n&&e.set(n,{type:"step",name:i,direction:1,ring:!o});for(let{name:i,key:o,held:n}of ge(t))e.set(o,{type:n?"hold":"act",name:i});return e}function Ts(s,t){if(s.ctrlKey||s.altKey||s.metaKey||s.isComposing||s.defaultPrevented||It(s.target)||s.key===" "&&zo.has(s.target?.tagName))return null;let e=t.get(_s(s.key));return!e||s.repeat&&(e.type==="act"||e.ring)?null:e.ring&&s.shiftKey?{...e,direction:-e.direction}:e}var Ft=class{constructor(t){this.plan=t,this.down=new Set,this.fast=!1}press(t){this.down.add(t)}release(t){let e=this.plan.get(_s(t));e?.type==="hold"&&this.down.delete(e.name)}clear(){this.down.clear(),this.fast=!1}axis(t,e){return Number(this.down.has(t))-Number(this.down.has(e))}get any(){return this.down.size>0}};var Nt={pause:"M9 5v14M15 5v14",play:"M8 5l11 7-11 7z",view:"M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12zM12 9a3 3 0 1 0 0 6 3 3 0 0 0 0-6z",few_waves:"M2 9c2.5 0 2.5-3 5-3s2.5 3 5 3 2.5-3 5-3 2.5 3 5 3M2 17c2.5 0 2.5-3 5-3s2.5 3 5 3 2.5-3 5-3 2.5 3 5 3",screenshot:"M4 8h3l2-3h6l2 3h3v11H4zM12 10a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7z",controls:"M4 7h9M17 7h3M4 17h3M11 17h9M15 5v4M9 15v4",help:"M9 9.2a3 3 0 1 1 4.6 2.6c-1 .7-1.6 1.2-1.6 2.5M12 17.6v.4M12 2.5a9.5 9.5 0 1 0 0 19 9.5 9.5 0 0 0 0-19z",close:"M6 6l12 12M18 6L6 18"};function H(s,t,e,i,o={}){let n=e?`${t} (${J(e)})`:t;return d("button",{type:"button",class:`tool tool-${s}`,"aria-label":t,"aria-keyshortcuts":e===" "?"Space":e,"data-hint":n,on:{click:i},...o},Et(Nt[s]))}function Co(s,t,e){return d("button",{type:"button",class:"action","aria-keyshortcuts":t,on:{click:e}},d("span",{text:s}),t?d("kbd",{text:J(t)}):null)}function Ss(s,t){let e=k("title"),i=d("div",{class:"dialog-body"}),o=d("dialog",{class:`sheet ${t}`,"aria-labelledby":e},d("div",{class:"dialog-head"},d("h2",{id:e,text:s}),d("button",{type:"button",class:"tool close","aria-label":"Close",on:{click:()=>o.close()}},Et(Nt.close))),i);return{node:o,content:i}}var Lt=class{constructor(t,{canvas:e,act:i,title:o="fftocean"}){this.root=t,this.act=i,t.classList.add("fftocean");let n=k("figures"),r=k("controls");this.chip=d("button",{type:"button",class:"chip","aria-expanded":"false","aria-controls":n,"aria-label":"Figures of the sea",on:{click:()=>this.toggle("figures")}}),this.figures=d("section",{id:n,class:"panel figures","aria-label":"Figures of the sea",tabindex:"-1",hidden:!0}),this.actions=d("div",{class:"actions"}),this.controls=d("section",{id:r,class:"panel controls","aria-label":"Controls",tabindex:"-1",hidden:!0}),this.pauseButton=H("pause","Pause"," ",()=>i("pause")),this.viewButton=H("view","Next view","v",()=>i("view")),this.fewButton=H("few_waves","Few-wave models","g",()=>i("few_waves")),this.controlsButton=H("controls","Controls","",()=>this.toggle("controls"),{"aria-expanded":"false","aria-controls":r}),this.bar=d("div",{class:"bar",role:"toolbar","aria-label":"Tools"},this.pauseButton,this.viewButton,this.fewButton,H("screenshot","Save a screenshot","x",()=>i("screenshot")),this.controlsButton,H("help","Keys","?",()=>i("help"))),this.viewLabel=d("p",{class:"view-label","aria-hidden":"true"}),this.split=["left","right"].map(a=>d("p",{class:`half ${a}`})),this.halves=d("div",{class:"halves",hidden:!0},...this.split),this.spoken=d("p",{class:"spoken",role:"status","aria-live":"polite"}),this.toasts=d("div",{class:"toasts"}),this.banner=d("div",{class:"banner",role:"alert",hidden:!0}),this.dropHint=d("div",{class:"drop-hint","aria-hidden":"true",hidden:!0}),this.dropHint.append(d("p",{text:"Drop a job or a buoy file"})),this.help=Ss("Keys","help"),this.text=Ss("Copy","copy"),this.canvas=e,t.prepend(e),t.append(d("h1",{class:"spoken",text:o}),d("div",{class:"frame"},d("div",{class:"top"},this.chip,this.figures),this.controls,d("div",{class:"bottom"},this.viewLabel,this.halves,this.bar)),this.toasts,this.banner,this.dropHint,this.spoken,this.help.node,this.text.node)}get wide(){let t=Number.parseFloat(getComputedStyle(this.root).fontSize);return this.root.clientWidth>=56*t}toggle(t,e=this[t].hidden){let i={figures:this.chip,controls:this.controlsButton};if(e&&!this.wide)for(let o of Object.keys(i))o!==t&&this.toggle(o,!1);this[t].hidden=!e,i[t].setAttribute("aria-expanded",String(e)),this.root.classList.toggle(`with-${t}`,e),this.onToggle?.(t,e)}close(t){this[t].contains(document.activeElement)&&this.canvas.focus(),this.toggle(t,!1)}addAction(t,e,i){let o=Co(t,e,i);return this.actions.append(o),o}showPaused(t){this.pauseButton.replaceChildren(Et(t?Nt.play:Nt.pause));let e=t?"Go on":"Pause";this.pauseButton.setAttribute("aria-label",e),this.pauseButton.dataset.hint=`${e} (Space)`,this.pauseButton.setAttribute("aria-pressed",String(t))}showView(t){this.viewLabel.textContent=t,this.viewLabel.hidden=!t}showSplit(t){this.root.classList.toggle("split",!!t),this.halves.hidden=!t,this.split.forEach((e,i)=>{t&&e.textContent!==t[i]&&(e.textContent=t[i])})}toast(t,e="note"){for(let n of[...this.toasts.children])n.textContent===t&&n.remove();for(;this.toasts.children.length>2;)this.toasts.firstChild.remove();let i=d("p",{class:`toast ${e}`,role:e==="refusal"?"alert":"status",text:t});return this.toasts.append(i),setTimeout(()=>i.remove(),1e3*(e==="refusal"?12:5)),i}showBanner(t){this.banner.replaceChildren(...t?[d("p",{text:t})]:[]),this.banner.hidden=!t}showText(t,e){this.text.node.querySelector("h2").textContent=t;let i=d("textarea",{readonly:!0,rows:"14","aria-label":t});i.value=e,this.text.content.replaceChildren(i),this.text.node.showModal(),i.focus(),i.select()}fillHelp(t,{enabled:e,onEnabled:i}){let o=k("field"),n=d("input",{id:o,type:"checkbox",role:"switch"});n.checked=e,n.addEventListener("change",()=>i(n.checked)),this.help.content.replaceChildren(d("dl",{class:"keys-list"},...t.map(([r,a])=>d("div",{},d("dt",{},...r.map(c=>d("kbd",{text:J(c)}))),d("dd",{text:a})))),d("p",{class:"note",text:"Drag to look round, turn the wheel or pinch to move. Shift goes faster, or backward through a list. Keys are left alone while a field has the focus; Escape leaves it."}),d("div",{class:"control-head"},d("label",{for:o,text:"Keys"}),n))}toggleHelp(){this.help.node.open?this.help.node.close():this.help.node.showModal()}dispose(){this.root.replaceChildren()}};var j=36,Ot=14;function Ms(s,t,e=j){let i=t.length-1,o=new Float64Array(i*e),n=Do(t,s.document.loop);for(let r of s.tiles){let{nx:a,ny:c,lx:l,ly:h,h0:u,wave:f}=r;for(let m=0;m<c;m+=1){let p=m<c/2?m:m-c;for(let g=0;g<a;g+=1){let v=m*a+g,w=u[4*v],x=u[4*v+1],y=2*(w*w+x*x);if(y===0)continue;let _=n(f[2*v]);if(_<0)continue;let S=g<a/2?g:g-a,R=Math.atan2(p/h,S/l)/(2*Math.PI)+1,F=Math.round(R*e)%e;o[_*e+F]+=y}}}return o}function Do(s,t){let e=Math.ceil(s.at(-1)*t),i=new Int16Array(e+1).fill(-1),o=0;for(let n=0;n<=e;n+=1){let r=n/t;if(!(r<s[0])){for(;o<s.length-1&&r>=s[o+1];)o+=1;o<s.length-1&&(i[n]=o)}}return n=>i[n]??-1}function Bo(s,t=.02,e=4,i=1.12){let o=[Math.max(.5,Math.floor(t*s)-.5)];for(;o.at(-1)/s<e;){let n=o.at(-1);o.push(n+Math.max(1,Math.round(n*(i-1))))}return Float64Array.from(o,n=>n/s)}function Uo(s,t,e){return Float64Array.from({length:e+1},(i,o)=>s*(t/s)**(o/e))}function qo(s,t,e=j){let i=t.length-1,o=new Float64Array(i),n=new Float64Array(i);for(let r=0;r<i;r+=1){let a=0;for(let c=0;c<e;c+=1)a+=s[r*e+c];o[r]=(t[r]+t[r+1])/2,n[r]=a/(t[r+1]-t[r])}return{frequency:o,density:n}}function Go(s){let{frequency:t,density:e}=s,i=Math.max(...e),o=t.filter((n,r)=>e[r]>.004*i);return o.length?[Math.min(...o)*.8,Math.max(...o)*1.1]:[.02,1]}function As(s){let t=Math.min(2,globalThis.devicePixelRatio||1),e=s.clientWidth||280,i=s.clientHeight||130;return{ratio:t,width:e,height:i,pixels:[Math.round(e*t),Math.round(i*t)]}}function ve(s){let[t,e]=As(s).pixels;return s.width===t&&s.height===e}function ks(s,t,e){let{ratio:i,width:o,height:n,pixels:r}=As(s);ve(s)||([s.width,s.height]=r);let a=s.getContext("2d");a.setTransform(i,0,0,i,0,0),a.clearRect(0,0,o,n);let c=Bo(t.document.loop),l=Ms(t,c),h=qo(l,c),{spectrum:u}=t.document,f=u?.density?u:null,m=Math.min(n,o*.42);Ho(a,{width:o-m-12,height:n},f,h,e),Vo(a,{left:o-m,size:m,top:(n-m)/2},t,c,e)}function Ho(s,t,e,i,o){let n=t.height-16,[r,a]=Go(e??i),c=1.15*Math.max(...(e??i).density,1e-12),l=u=>(u-r)/(a-r)*t.width,h=u=>n-(n-12)*Math.min(1,u/c);s.strokeStyle=o.grid,s.lineWidth=1,s.beginPath(),s.moveTo(0,n+.5),s.lineTo(t.width,n+.5),s.stroke(),s.fillStyle=o.text,s.font=o.font,s.textBaseline="alphabetic";for(let u of jo(r,a)){let f=`${Number(u.toPrecision(3))}`;s.textAlign=l(u)<12?"left":l(u)>t.width-12?"right":"center",s.fillText(f,l(u),t.height-3),s.fillRect(l(u),n,1,3)}s.textAlign="right",s.fillText("f [Hz]",t.width,9),s.save(),s.beginPath(),s.rect(0,0,t.width,n),s.clip(),s.beginPath(),s.moveTo(l(i.frequency[0]),n);for(let u=0;u<i.frequency.length;u+=1)s.lineTo(l(i.frequency[u]),h(i.density[u]));s.lineTo(l(i.frequency.at(-1)),n),s.fillStyle=o.area,s.fill(),s.strokeStyle=o.second,s.lineWidth=1.25,s.stroke(),e&&(s.beginPath(),e.frequency.forEach((u,f)=>{f?s.lineTo(l(u),h(e.density[f])):s.moveTo(l(u),h(e.density[f]))}),s.strokeStyle=o.line,s.lineWidth=1.75,s.stroke()),s.restore()}function jo(s,t){let e=(t-s)/3,i=10**Math.floor(Math.log10(e)),o=[1,2,5,10].map(r=>r*i).find(r=>r>=e)??e,n=[];for(let r=Math.ceil(s/o)*o;r<=t;r+=o)n.push(r);return n}function Vo(s,t,e,i,o){let[n,r]=Wo(e),a=Uo(n,r,Ot),c=Ms(e,a),l=t.size/2-9,h=t.left+t.size/2,u=t.top+t.size/2,f=Math.max(...c,1e-30),m=Math.PI/j;for(let g=0;g<Ot;g+=1){let v=l*(.12+.88*g/Ot),w=l*(.12+.88*(g+1)/Ot);for(let x=0;x<j;x+=1){let y=Math.sqrt(c[g*j+x]/f);if(y<.03)continue;let _=-(2*Math.PI*x)/j;s.globalAlpha=Math.min(1,y),s.fillStyle=o.second,s.beginPath(),s.arc(h,u,w,_-m,_+m),s.arc(h,u,v,_+m,_-m,!0),s.fill()}}s.globalAlpha=1,s.strokeStyle=o.grid,s.lineWidth=1;for(let g of[.5,1])s.beginPath(),s.arc(h,u,l*g,0,2*Math.PI),s.stroke();let{specified:p}=e.document.statistics??{};p&&!fe(p)&&Xo(s,h,u,l,p.direction,o.line),s.fillStyle=o.text,s.font=o.font,s.textAlign="center",s.textBaseline="middle",s.fillText("N",h,u-l-5),s.fillText("E",h+l+5,u)}function Wo(s){let t=s.document.statistics?.specified?.tp,e=t>0?1/t:.12;return[e/2.2,e*5]}function Xo(s,t,e,i,o,n){if(typeof o!="number"||!Number.isFinite(o))return;let r=-o*Math.PI/180;s.strokeStyle=n,s.lineWidth=1.75,s.beginPath(),s.moveTo(t+.12*i*Math.cos(r),e+.12*i*Math.sin(r)),s.lineTo(t+i*Math.cos(r),e+i*Math.sin(r)),s.stroke()}function Rs(s){return s.replace("EXPOSURE_KEY",3.2.toFixed(4)).replace("EXPOSURE_CAP",1.5.toFixed(4))}function tt(s){return 2**s}var xe=.12,$=`
uniform float exposure_factor;
uniform bool linear_light;
float grain(vec2 at,float shift){
return fract(52.9829189*fract(dot(at + shift*5.588238,vec2(0.06711056,0.00583715))));
}
vec3 curve(vec3 light){
vec3 x=0.5*light;
float grey=dot(x,vec3(0.3333));
x=mix(x,vec3(grey),${xe.toFixed(3)});
x=clamp(x*(2.4*x + 0.3)/(x*(2.4*x + 0.85) + 0.33),0.0,1.0);
grey=dot(x,vec3(0.3333));
return clamp((x - ${xe.toFixed(3)}*grey)/(1.0 - ${xe.toFixed(3)}),0.0,1.0);
}
vec3 coded(vec3 linear){
return mix(12.92*linear,1.055*pow(linear,vec3(1.0/2.4)) - 0.055,
step(0.0031308,linear));
}
vec4 shown(vec3 radiance,float exposure){
if (linear_light) return vec4(radiance,1.0);
vec3 screen=coded(curve(radiance*exposure*exposure_factor));
vec2 at=gl_FragCoord.xy;
vec3 noise=vec3(grain(at,0.0),grain(at,1.0),grain(at,2.0)) - 0.5;
return vec4(screen + noise/255.0,1.0);
}
`;var Fs=`#version 300 es
void main(){
vec2 corner=vec2(gl_VertexID & 1,gl_VertexID>>1);
gl_Position=vec4(corner*4.0 - 1.0,0.0,1.0);
}`,E=`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
`,$t=class extends Error{constructor(){super("the graphics context is lost"),this.name="ContextLost"}};function Yo(s,t){let e={R8:[s.RED,s.UNSIGNED_BYTE],RG8:[s.RG,s.UNSIGNED_BYTE],RGBA8:[s.RGBA,s.UNSIGNED_BYTE],SRGB8_ALPHA8:[s.RGBA,s.UNSIGNED_BYTE],R16F:[s.RED,s.HALF_FLOAT],RG16F:[s.RG,s.HALF_FLOAT],RGBA16F:[s.RGBA,s.HALF_FLOAT],R32F:[s.RED,s.FLOAT],RG32F:[s.RG,s.FLOAT],RGBA32F:[s.RGBA,s.FLOAT],DEPTH_COMPONENT24:[s.DEPTH_COMPONENT,s.UNSIGNED_INT]};if(!e[t])throw new Error(`a texture's format must be known, got ${t}`);return e[t]}function Ee(s,t){let{gl:e,handle:i}=s;i&&e[`is${t}`](i)&&e[`delete${t}`](i),s.handle=null}var ye=class{constructor(t,e,i=Fs,o=[]){this.gl=t,this.handle=t.createProgram();let n=[[t.VERTEX_SHADER,i],[t.FRAGMENT_SHADER,e]].map(([h,u])=>{let f=t.createShader(h);if(!f)throw new $t;return t.shaderSource(f,u),t.compileShader(f),t.attachShader(this.handle,f),f});o.length&&t.transformFeedbackVaryings(this.handle,o,t.INTERLEAVED_ATTRIBS),t.linkProgram(this.handle);let r=t.getProgramParameter(this.handle,t.LINK_STATUS),a=n.map(h=>t.getShaderInfoLog(h));for(let h of n)t.deleteShader(h);if(!r){if(t.isContextLost())throw new $t;let h=[...a,t.getProgramInfoLog(this.handle)].filter(Boolean).join(`
`);throw t.deleteProgram(this.handle),new Error(`a shader does not compile: ${h}`)}this.uniforms=new Map;let c=t.getProgramParameter(this.handle,t.ACTIVE_UNIFORMS),l=0;for(let h=0;h<c;h++){let{name:u,type:f,size:m}=t.getActiveUniform(this.handle,h),p=Ko[f];if(!p)throw new Error(`uniform ${u}has a type that is not supported:${f}`);let g=t.getUniformLocation(this.handle,u);this.uniforms.set(u.replace("[0]",""),{place:g,setter:p,size:m,unit:l}),p===Is&&(l+=m)}}use(t){let{gl:e}=this;e.useProgram(this.handle);for(let[i,{place:o,setter:n,size:r,unit:a}]of this.uniforms){let c=t[i];if(c===void 0)throw new Error(`the uniform ${i}was not given`);n(e,o,c,r,a)}}dispose(){Ee(this,"Program")}};function Is(s,t,e,i,o){let n=Array.isArray(e)?e:[e],r=Int32Array.from({length:i},(a,c)=>o+c);n.slice(0,i).forEach((a,c)=>{s.activeTexture(s.TEXTURE0+o+c),s.bindTexture(s.TEXTURE_2D,a.handle)}),s.uniform1iv(t,r)}function I(s){return(t,e,i)=>t[s](e,Ns(i))}function we(s){return(t,e,i)=>t[s](e,!1,Ns(i))}function Ns(s){return typeof s=="number"||typeof s=="boolean"?[Number(s)]:Array.isArray(s)?s.flat():s}var Ko={5124:I("uniform1iv"),35667:I("uniform2iv"),35668:I("uniform3iv"),35669:I("uniform4iv"),5125:I("uniform1uiv"),35670:I("uniform1iv"),5126:I("uniform1fv"),35664:I("uniform2fv"),35665:I("uniform3fv"),35666:I("uniform4fv"),35674:we("uniformMatrix2fv"),35675:we("uniformMatrix3fv"),35676:we("uniformMatrix4fv"),35678:Is};function T(s,t,e=Fs,i=[]){return new ye(s,t,e,i)}var be=class{constructor(t,e){let{format:i,width:o,height:n,data:r=null,filter:a="nearest",wrap:c="repeat"}=e;this.gl=t,this.format=i,this.width=o,this.height=n,this.handle=t.createTexture(),this.levels=e.mips?Math.floor(Math.log2(Math.max(o,n)))+1:1,t.bindTexture(t.TEXTURE_2D,this.handle),t.texStorage2D(t.TEXTURE_2D,this.levels,t[i],o,n);let l=a==="linear"?t.LINEAR:t.NEAREST,h=a==="linear"?t.LINEAR_MIPMAP_LINEAR:t.NEAREST_MIPMAP_NEAREST,u=c==="repeat"?t.REPEAT:t.CLAMP_TO_EDGE;for(let[m,p]of[[t.TEXTURE_MAG_FILTER,l],[t.TEXTURE_MIN_FILTER,this.levels>1?h:l],[t.TEXTURE_WRAP_S,u],[t.TEXTURE_WRAP_T,u]])t.texParameteri(t.TEXTURE_2D,m,p);let f=e.anisotropy&&t.getExtension("EXT_texture_filter_anisotropic");if(f){let m=t.getParameter(f.MAX_TEXTURE_MAX_ANISOTROPY_EXT),p=Math.min(e.anisotropy,m);t.texParameterf(t.TEXTURE_2D,f.TEXTURE_MAX_ANISOTROPY_EXT,p)}r&&this.upload(r)}upload(t,e=0){let{gl:i}=this,[o,n]=Yo(i,this.format),r=Math.max(1,this.width>>e),a=Math.max(1,this.height>>e);i.bindTexture(i.TEXTURE_2D,this.handle),i.pixelStorei(i.UNPACK_ALIGNMENT,1),i.texSubImage2D(i.TEXTURE_2D,e,0,0,r,a,o,n,t)}generateMips(){this.gl.bindTexture(this.gl.TEXTURE_2D,this.handle),this.gl.generateMipmap(this.gl.TEXTURE_2D)}dispose(){Ee(this,"Texture")}};function b(s,t){return new be(s,t)}var _e=class{constructor(t,e,i=null){this.gl=t,this.textures=e,this.depth=i,this.width=(e[0]??i).width,this.height=(e[0]??i).height,this.handle=t.createFramebuffer(),t.bindFramebuffer(t.FRAMEBUFFER,this.handle);let o=(n,{handle:r})=>t.framebufferTexture2D(t.FRAMEBUFFER,n,t.TEXTURE_2D,r,0);e.forEach((n,r)=>o(t.COLOR_ATTACHMENT0+r,n)),i&&o(t.DEPTH_ATTACHMENT,i),t.drawBuffers(e.map((n,r)=>t.COLOR_ATTACHMENT0+r)),this.complete=t.checkFramebufferStatus(t.FRAMEBUFFER)===t.FRAMEBUFFER_COMPLETE}bind(){this.gl.bindFramebuffer(this.gl.FRAMEBUFFER,this.handle),this.gl.viewport(0,0,this.width,this.height)}read(t=0){let{gl:e,width:i,height:o}=this,n=new Float32Array(4*i*o);return e.bindFramebuffer(e.FRAMEBUFFER,this.handle),e.readBuffer(e.COLOR_ATTACHMENT0+t),e.readPixels(0,0,i,o,e.RGBA,e.FLOAT,n),n}dispose({keepTextures:t=!1}={}){if(Ee(this,"Framebuffer"),!t){for(let e of this.textures)e.dispose();this.depth?.dispose()}}};function M(s,t,e=null){return new _e(s,t,e)}function A(s,t,e,i=null){et(s,t,e,i,s.TRIANGLES,3)}function et(s,t,e,i,o,n,r=1){t.use(e),i?.bind(),r===1?s.drawArrays(o,0,n):s.drawArraysInstanced(o,0,n,r)}var Os=new Float32Array(1),Ls=new Uint32Array(Os.buffer);function Qo(s){Os[0]=s;let t=Ls[0]>>>16&32768,e=Ls[0]&2147483647;if(e>2139095040)return 32256;if(e>=1199566848)return t|31744;if(e<947912704){let i=Math.abs(s)*16777216,o=Math.floor(i),n=i-o;return t|o+(n>.5||n===.5&&o&1?1:0)}return t|e-939524096+4095+(e>>>13&1)>>>13}function Pt(s){let t=new Uint16Array(s.length);for(let e=0;e<s.length;e++)t[e]=Qo(s[e]);return t}var st=256,Cs=8,$s=72,Ps=6,Jo=60;function zs(s){let t=Math.imul(s+1,739982445);return t=Math.imul(t^t>>>15,695872825),t=Math.imul(t^t>>>13,1540483477),((t^t>>>16)>>>0)/2**32}function Zo(){let s=st,t=Float32Array.from({length:s},(i,o)=>Math.sin(2*Math.PI*o/s)),e=[0,1].map(()=>new Float32Array(s*s));for(let i=0;i<$s;i++){let o=Ps*(Jo/Ps)**(i/($s-1)),n=2*Math.PI*zs(2*i),r=Math.round(o*Math.cos(n)),a=Math.round(o*Math.sin(n)),c=Math.hypot(r,a),l=Math.floor(s*zs(2*i+1));for(let h=0;h<s;h++)for(let u=0;u<s;u++){let f=t[r*u+a*h+l&s-1];e[0][h*s+u]+=a/c*f,e[1][h*s+u]-=r/c*f}}return e.map(i=>{let o=i.reduce((n,r)=>Math.max(n,Math.abs(r)),0);return i.map(n=>n/o)})}function Ds(){let s=Zo(),t=[];for(let e=st;e>=1;e/=2){let[i,o]=s,n=new Float32Array(2*e*e);i.forEach((r,a)=>n.set([r,o[a]],2*a)),t.push(Pt(n)),s=s.map(r=>tn(r,e))}return t}function tn(s,t){let e=t>>1;return Float32Array.from({length:e*e},(i,o)=>{let n=2*Math.floor(o/e)*t+2*(o%e);return .25*(s[n]+s[n+1]+s[n+t]+s[n+t+1])})}var Bs=[610,550,465],en=[.2644,.0565,.01006],sn=.00288,on=-4.32,nn=[.236,.357,.89];function zt(s){if(!(s>0))throw new RangeError(`chlorophyll must be positive, got ${s} mg/m^3`);let t=.3*s**.62,e=Bs.map((o,n)=>(en[n]+.06*nn[n]*s**.65)*(1+.2*Math.exp(-.014*(o-440)))),i=Bs.map(o=>{let n=.5*sn*(o/500)**on,r=.002+.02*(.5-.25*Math.log10(s))*550/o;return n+t*r});return{absorption:e,backscattering:i}}function Ct({absorption:s,backscattering:t}){return s.map((e,i)=>{let o=t[i]/(e+t[i]),n=(.0949+.0794*o)*o;return .52*n/(1-1.7*n)})}var Te=40,Se=28,Us=`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
uniform mat4 view_projection;
uniform sampler2D floating,floating_tilt;
uniform float eye_height;
out vec3 at;
out vec3 normal,place;
float radius(float z){
if (z<-0.6) return 0.02;
if (z<-0.1) return mix(0.12,0.42,(z + 0.6)/0.5);
if (z<0.3) return 0.42;
if (z<0.42) return mix(0.42,0.26,(z - 0.3)/0.12);
if (z<1.3) return mix(0.24,0.075,(z - 0.42)/0.88);
if (z<1.78) return 0.035;
if (z<2.0) return 0.085*sqrt(max(1.0 - pow((z - 1.89)/0.11,4.0),0.0));
return 0.0;
}
void main(){
const float[12] HEIGHTS=float[12](-0.7,-0.6,-0.1,0.29,0.3,0.42,1.29,1.31,1.77,1.8,1.98,2.0);
int ring=gl_InstanceID + (gl_VertexID & 1),column=gl_VertexID>>1;
float share=float(ring)/${(Te-1).toFixed(1)}*11.0;
int first=min(int(share),10);
float z=mix(HEIGHTS[first],HEIGHTS[first + 1],share - float(first));
float angle=float(column)/${Se.toFixed(1)}*6.28318531;
vec2 out_=vec2(cos(angle),sin(angle));
float r=radius(z),rise=(radius(z + 0.01) - radius(z - 0.01))/0.02;
at=vec3(out_*r,z);
vec3 up=normalize(vec3(-0.7*texelFetch(floating_tilt,ivec2(1,0),0).xy,1.0));
vec3 east=normalize(vec3(1.0,0.0,0.0) - up*up.x),north=cross(up,east);
mat3 turned=mat3(east,north,up);
normal=turned*normalize(vec3(out_,-clamp(rise,-4.0,4.0)));
vec3 foot=texelFetch(floating,ivec2(1,0),0).xyz;
float eye=max(eye_height,texelFetch(floating,ivec2(0),0).z + 0.45);
place=foot - vec3(0.0,0.0,eye) + turned*at;
gl_Position=view_projection*vec4(place,1.0);
}`;function qs(s){return`${E}${s}
uniform sampler2D light;
uniform vec3 sunward;
in vec3 at,normal,place;
out vec4 colour;
void main(){
vec3 n=normalize(normal),to_eye=-normalize(place);
vec3 sun_light=texelFetch(light,ivec2(0),0).rgb,sky_light=texelFetch(light,ivec2(1,0),0).rgb;
vec3 paint=at.z<0.0?vec3(0.16,0.03,0.02)
:fract(at.z)<0.5?vec3(0.80,0.60,0.04):vec3(0.62,0.05,0.03);
if (at.z>1.78) paint=vec3(0.75);
float wet=smoothstep(0.25,0.05,at.z);
paint*=1.0 - 0.45*wet;
float from_sun=max(dot(n,sunward),0.0);
vec3 scattered=paint/3.14159265*(sun_light*from_sun + sky_light*(0.55 + 0.45*n.z));
vec3 halfway=normalize(sunward + to_eye);
float gloss=mix(60.0,200.0,wet);
float mirror=0.04*(gloss + 8.0)/25.0*pow(max(dot(n,halfway),0.0),gloss)*from_sun;
float edge=0.04 + 0.5*pow(1.0 - max(dot(n,to_eye),0.0),5.0);
colour=shown(scattered + sun_light*mirror + edge*sky_light*0.25,texelFetch(light,ivec2(3,0),0).x);
}`}var P=`
const float SKY_SCALE=0.5/1.1;
vec2 sky_place(vec3 direction){
return direction.xy/(1.0 + max(direction.z,-0.05))*SKY_SCALE + 0.5;
}
`,Me=`
const float PI=3.14159265;
const float EARTH=6371e3,AIR_TOP=6471e3;
const vec3 RAYLEIGH=vec3(5.802e-6,13.558e-6,33.1e-6);
const vec3 OZONE=vec3(0.650e-6,1.881e-6,0.085e-6);
const float MIE=4.0e-6,MIE_EXTINCTION=4.4e-6,MIE_FORWARD=0.78;
const float SUN_IRRADIANCE=20.0;
uniform vec3 sun;
uniform float haze;
float way_out(vec3 from,vec3 direction){
float along=dot(from,direction);
return -along + sqrt(max(along*along - dot(from,from) + AIR_TOP*AIR_TOP,0.0));
}
vec3 density(vec3 at){
float height=max(length(at) - EARTH,0.0);
float ozone=max(0.0,1.0 - abs(height - 25e3)/15e3);
return vec3(exp(-height/8000.0),exp(-height/1200.0),ozone);
}
vec3 transmitted(vec3 column){
return exp(-(RAYLEIGH*column.x + MIE_EXTINCTION*haze*column.y + OZONE*column.z));
}
vec3 sunlight(vec3 at){
float way=way_out(at,sun),along=dot(at,sun);
vec3 column=vec3(0.0);
for (int i=0;i<12;i++){
float share=(float(i) + 0.5)/12.0;
column +=density(at + sun*way*share*share)*(2.0*share*way/12.0);
}
float closest=length(at - along*sun);
float lit=along>0.0?1.0:smoothstep(EARTH - 6e3,EARTH + 6e3,closest);
return lit*transmitted(column);
}
vec3 clear_sky(vec3 direction){
vec3 from=vec3(0.0,0.0,EARTH + 20.0);
float way=way_out(from,direction),cosine=dot(direction,sun);
float g=MIE_FORWARD,g2=g*g;
float rayleigh_phase=3.0/(16.0*PI)*(1.0 + cosine*cosine);
float mie_phase=3.0/(8.0*PI)*(1.0 - g2)*(1.0 + cosine*cosine)/
((2.0 + g2)*pow(1.0 + g2 - 2.0*g*cosine,1.5));
vec3 again=1.05*sunlight(vec3(0.0,0.0,EARTH + 3000.0))*max(sun.z + 0.08,0.0) +
0.03*sunlight(vec3(0.0,0.0,EARTH + 20e3));
vec3 column=vec3(0.0),once=vec3(0.0),more=vec3(0.0);
float last=0.0;
for (int i=0;i<32;i++){
float share=(float(i) + 0.5)/32.0,next=(float(i) + 1.0)/32.0;
next*=next*way;
float stretch=next - last;
last=next;
vec3 at=from + direction*share*share*way,air=density(at);
column +=air*stretch;
vec3 seen=transmitted(column)*stretch;
vec3 scattered=RAYLEIGH*air.x,haze_scattered=vec3(MIE*haze*air.y);
once +=seen*sunlight(at)*(scattered*rayleigh_phase + haze_scattered*mie_phase);
more +=seen*(scattered + haze_scattered)/(4.0*PI);
}
return SUN_IRRADIANCE*(once + more*again);
}
`,Gs=`
uniform float clouds;
uint scrambled(uint x){
x ^=x>>16;x*=0x7feb352du;x ^=x>>15;x*=0x846ca68bu;x ^=x>>16;
return x;
}
float lattice_value(ivec2 at){
return float(scrambled(uint(at.x)*73856093u + scrambled(uint(at.y) + 17u)))/4294967296.0;
}
float smooth_noise(vec2 at){
ivec2 cell=ivec2(floor(at));
vec2 part=fract(at);
part=part*part*part*(part*(part*6.0 - 15.0) + 10.0);
vec2 low=vec2(lattice_value(cell),lattice_value(cell + ivec2(1,0)));
vec2 high=vec2(lattice_value(cell + ivec2(0,1)),lattice_value(cell + ivec2(1,1)));
vec2 both=mix(low,high,part.y);
return mix(both.x,both.y,part.x);
}
float cloud_cover(vec3 direction){
if (clouds<=0.0 || direction.z<=0.01) return 0.0;
float up=max(direction.z,0.02);
float way=0.0022/(up + sqrt(up*up + 0.0022));
vec2 at=direction.xy*way*430.0 + 4.3;
at=mat2(0.86,0.5,-0.5,0.86)*at;
vec2 bent=vec2(smooth_noise(at*0.8 + 7.0),smooth_noise(at*0.8 + 31.0));
vec2 drawn=(at + 1.3*bent)*vec2(0.42,1.5);
float sum=0.0,weight=0.5;
for (int i=0;i<6;i++){
sum +=weight*smooth_noise(drawn);
drawn=mat2(0.8,0.6,-0.6,0.8)*drawn*2.03 + 3.7;
weight*=0.53;
}
float patches=smoothstep(0.25,0.75,smooth_noise(at*0.45 + 11.0));
float cover=smoothstep(0.82 - 0.5*clouds,1.12 - 0.3*clouds,sum + 0.28*patches);
return cover*smoothstep(0.015,0.12,direction.z);
}
vec3 with_clouds(vec3 clear,vec3 direction,vec3 sunward,vec3 cloud_sun,vec3 cloud_sky){
float cover=cloud_cover(direction);
if (cover<=0.0) return clear;
float cosine=max(dot(direction,sunward),0.0);
float forward=0.055 + 0.10*pow(cosine,4.0) + 0.35*pow(cosine,48.0);
vec3 lit=cloud_sun*forward*(1.0 - 0.35*cover) + cloud_sky*0.8;
float near=exp(-0.05/max(direction.z,0.03));
return mix(clear,mix(clear,lit,near),cover*0.8);
}
`,Hs=`${E}${P}${Me}
uniform float samples;
out vec4 radiance;
void main(){
vec2 at=(gl_FragCoord.xy/samples - 0.5)/SKY_SCALE;
float square=dot(at,at);
vec3 direction=vec3(2.0*at,1.0 - square)/(1.0 + square);
if (direction.z<0.002) direction=normalize(vec3(direction.xy,0.002));
radiance=vec4(clear_sky(direction),1.0);
}`,js=`${E}${P}${Me}${Gs}
uniform sampler2D clear_map;
uniform float samples;
out vec4 radiance;
void main(){
vec2 at=(gl_FragCoord.xy/samples - 0.5)/SKY_SCALE;
float square=dot(at,at);
vec3 direction=vec3(2.0*at,1.0 - square)/(1.0 + square);
vec3 clear=textureLod(clear_map,gl_FragCoord.xy/samples,0.0).rgb;
vec3 cloud_sun=SUN_IRRADIANCE*sunlight(vec3(0.0,0.0,EARTH + 7000.0));
vec3 zenith=textureLod(clear_map,vec2(0.5),0.0).rgb;
radiance=vec4(with_clouds(clear,direction,sun,cloud_sun,zenith),1.0);
}`,Vs=`${E}${P}${Me}
uniform sampler2D sky;
out vec4 light;
float luminance(vec3 colour){
return dot(colour,vec3(0.2126,0.7152,0.0722));
}
void main(){
int which=int(gl_FragCoord.x);
if (which==0){
light=vec4(SUN_IRRADIANCE*sunlight(vec3(0.0,0.0,EARTH + 20.0)),1.0);
return;
}
if (which==2){
light=vec4(SUN_IRRADIANCE*sunlight(vec3(0.0,0.0,EARTH + 7000.0)),1.0);
return;
}
vec3 irradiance=vec3(0.0);
float bright=0.0,area=0.0;
for (int y=0;y<32;y++){
for (int x=0;x<32;x++){
vec2 at=(vec2(x,y) + 0.5)/32.0,from_zenith=(at - 0.5)/SKY_SCALE;
float square=dot(from_zenith,from_zenith);
if (square>1.0) continue;
float solid=4.0/((1.0 + square)*(1.0 + square));
float up=(1.0 - square)/(1.0 + square);
vec3 radiance=textureLod(sky,at,log2(float(textureSize(sky,0).x)/32.0)).rgb;
irradiance +=radiance*solid*up;
float level=luminance(radiance),seen=up<0.6?solid:0.0;
bright +=pow(level,8.0)*seen;
area +=seen;
}
}
float cell=1.0/(32.0*32.0*SKY_SCALE*SKY_SCALE);
irradiance*=cell;
if (which==1){
light=vec4(irradiance,1.0);
return;
}
float from_sun=luminance(SUN_IRRADIANCE*sunlight(vec3(0.0,0.0,EARTH + 20.0)));
float middle=luminance(irradiance) + (0.25*max(sun.z,0.0) + 0.02)*from_sun;
float burnt=pow(bright/area,0.125);
light=vec4(min(EXPOSURE_KEY/(middle + 0.25),EXPOSURE_CAP/(burnt + 0.15)),irradiance);
}`,Ws=`#version 300 es
precision highp float;
uniform mat3 rays;
out vec3 ray;
void main(){
vec2 corner=vec2(gl_VertexID & 1,gl_VertexID>>1)*4.0 - 1.0;
gl_Position=vec4(corner,1.0,1.0);
ray=rays*vec3(corner,1.0);
}`,rn=`
vec3 sun_disc(vec3 direction,vec3 sunward,vec3 irradiance){
float angle=2.0*asin(min(0.5*length(direction - sunward),1.0));
float pixel=max(length(fwidth(direction)),1e-5);
float inside=clamp(0.5 - (angle - 0.00465)/pixel,0.0,1.0);
float glare=0.35*exp(-angle/0.012) + 0.03*exp(-angle/0.07);
return irradiance*(2000.0*inside + glare);
}
`;function Xs(s){return`${E}${P}${Gs}${rn}${s}
uniform sampler2D clear_map,light;
uniform vec3 sunward;
uniform vec3 plain;
in vec3 ray;
out vec4 colour;
void main(){
vec3 direction=normalize(ray);
if (plain.x>=0.0){
colour=vec4(plain,1.0);
return;
}
vec3 above=normalize(vec3(direction.xy,max(direction.z,0.003)));
vec3 radiance=textureLod(clear_map,sky_place(above),0.0).rgb;
vec3 zenith=textureLod(clear_map,vec2(0.5),0.0).rgb;
vec3 cloud_sun=texelFetch(light,ivec2(2,0),0).rgb;
radiance=with_clouds(radiance,direction,sunward,cloud_sun,zenith);
radiance +=sun_disc(direction,sunward,texelFetch(light,ivec2(0),0).rgb);
colour=shown(radiance,texelFetch(light,ivec2(3,0),0).x);
}`}function Dt(s,t){return Array.from({length:s},(e,i)=>t.replaceAll("TILE",String(i))).join(`
`)}function D(s){return`
uniform vec4 tile_frames[${s}];
uniform vec4 shear_waves[${s}];
uniform vec4 shear_shifts[${s}];
uniform vec2 shear_phases[${s}];
uniform sampler2D displacement_maps[${s}],slope_maps[${s}],moment_maps[${s}];
vec2 tile_place(int tile,vec2 rest){
vec4 waves=shear_waves[tile],shifts=shear_shifts[tile];
vec2 turned=cos(vec2(dot(waves.xy,rest),dot(waves.zw,rest)) + shear_phases[tile]);
vec2 sheared=rest + shifts.xy*turned.x + shifts.zw*turned.y;
return tile_frames[tile].xy + sheared*tile_frames[tile].zw;
}
void turn_slopes(int tile,vec2 rest,inout vec2 slope,inout vec3 moments){
vec4 waves=shear_waves[tile],shifts=shear_shifts[tile];
vec2 rate=sin(vec2(dot(waves.xy,rest),dot(waves.zw,rest)) + shear_phases[tile]);
mat2 turn=mat2(1.0) - rate.x*outerProduct(waves.xy,shifts.xy) -
rate.y*outerProduct(waves.zw,shifts.zw);
slope=turn*slope;
mat2 second=turn*mat2(moments.x,moments.z,moments.z,moments.y)*transpose(turn);
moments=vec3(second[0][0],second[1][1],second[0][1]);
}
`}function Ae(s){return`
vec3 displaced(vec2 rest,float spacing){
vec3 sum=vec3(0.0);
float level;
${Dt(s,`
level=max(log2(spacing*tile_frames[TILE].z*float(textureSize(displacement_maps[TILE],0).x)),0.0);
if (level<8.0) sum +=textureLod(displacement_maps[TILE],tile_place(TILE,rest),level).xyz;`)}
return sum;
}
`}function it(s,{spaced:t=!1}={}){let e=o=>t?`textureLod(${o}_maps[TILE], at, level)`:`texture(${o}_maps[TILE], at)`,i=`
  at = tile_place(TILE, rest);
  ${t?"level = max(log2(spacing * tile_frames[TILE].z * float(textureSize(slope_maps[TILE], 0).x)), 0.0);":""}
  slopes = ${e("slope")};
  moments = ${e("moment")}.xyz;
  turn_slopes(TILE, rest, slopes.xy, moments);
  sums.slope += slopes.xy;
  sums.stretch += vec3(slopes.zw, ${t?"0.0":`${e("displacement")}.w`});
  // Half floats leave a negative difference now and then.
  sums.variance.xy += max(moments.xy - slopes.xy * slopes.xy, 0.0);
  sums.variance.z += moments.z - slopes.x * slopes.y;`;return`
struct Sums {
  vec2 slope;
  vec3 stretch; // xx, yy, xy, with choppiness
  vec3 variance; // of slopes: xx, yy, xy
};

Sums summed(vec2 rest${t?", float spacing":""}) {
  Sums sums = Sums(vec2(0.0), vec3(0.0), vec3(0.0));
  vec2 at;
  vec4 slopes;
  vec3 moments;
  ${t?"float level;":""}
  ${Dt(s,i)}
  return sums;
}
`}function Ys(s){let t=s-1;return`
void add_ripples(vec2 rest, inout Sums sums, inout vec3 beyond) {
  vec3 whole = textureLod(moment_maps[${t}], vec2(0.5), 20.0).xyz;
  if (min(whole.x, whole.y) < 1e-6) return;
  float share = min(0.6 * min(beyond.x / whole.x, beyond.y / whole.y), 0.5);
  const mat2 TURN = mat2(0.8, 0.6, -0.6, 0.8);
  float shrunk = ${5.3.toFixed(1)};
  vec2 at = ripple_frame.xy + shrunk * ripple_frame.z * (TURN * rest);
  vec4 slopes = texture(slope_maps[${t}], at);
  vec3 moments = texture(moment_maps[${t}], at).xyz;
  vec2 slope = slopes.xy * TURN; // turned back
  mat2 second = transpose(TURN) * mat2(moments.x, moments.z, moments.z, moments.y) * TURN;
  mat2 all = transpose(TURN) * mat2(whole.x, whole.z, whole.z, whole.y) * TURN;
  float root = sqrt(share);
  sums.slope += root * slope;
  vec3 lost = vec3(second[0][0], second[1][1], second[0][1]) - vec3(slope * slope, slope.x * slope.y);
  beyond += share * (lost - vec3(all[0][0], all[1][1], all[0][1]));
}
`}function Ks(s){return`${E}${D(s)}
uniform sampler2D before;
uniform ivec2 corner,corner_before;
uniform vec2 corner_place;
uniform float cell,seconds,decay,threshold,strength;
uniform bool fresh;
out vec4 foam;
void main(){
int side=textureSize(before,0).x;
ivec2 place=ivec2(gl_FragCoord.xy);
ivec2 index=(place - corner) & (side - 1);
vec2 rest=corner_place + vec2(index)*cell;
vec3 stretch=vec3(0.0);
ivec2 samples,texel;
${Dt(s,`
samples=textureSize(slope_maps[TILE],0);
texel=ivec2(floor(fract(tile_place(TILE,rest))*vec2(samples))) & (samples - 1);
stretch +=vec3(texelFetch(slope_maps[TILE],texel,0).zw,
texelFetch(displacement_maps[TILE],texel,0).w);`)}
float middle=1.0 + 0.5*(stretch.x + stretch.y),half_difference=0.5*(stretch.x - stretch.y);
float smaller=middle - sqrt(half_difference*half_difference + stretch.z*stretch.z);
ivec2 old=corner + index - corner_before;
bool kept=!fresh && all(greaterThanEqual(old,ivec2(0))) && all(lessThan(old,ivec2(side)));
float left=kept?texelFetch(before,place,0).x*exp(-seconds/decay):0.0;
float made=kept?1.0 - exp(-seconds/decay):1.0;
float amount=left + made*decay*strength*max(threshold - smaller,0.0);
amount=min(amount,30.0);
foam=vec4(amount,1.0 - exp(-amount),smaller,1.0);
}`}var ke=`
uniform sampler2D foam_near,foam_far,break_up;
uniform vec4 foam_frames[2];
uniform mat2 break_up_axes;
uniform vec2 break_up_places[2];
uniform float break_up_larger;
float above(float x){
float square=0.5*x*x,part=square*(1.2732395 + 0.147*square)/(1.0 + 0.147*square);
return 0.5 - 0.5*sign(x)*sqrt(1.0 - exp(-part));
}
float threshold_of(float share){
float p=clamp(share,1e-4,1.0 - 1e-4),twice=1.0 - 2.0*p;
float logarithm=log(4.0*p*(1.0 - p)),part=4.3307468 + 0.5*logarithm;
return 1.4142136*sign(twice)*sqrt(max(sqrt(part*part - logarithm/0.147) - part,0.0));
}
float spread_cover(sampler2D window,vec2 place,float level){
vec2 cells=place*float(textureSize(window,0).x),along=dFdx(cells),across=dFdy(cells);
float pixel=0.5*log2(max(max(dot(along,along),dot(across,across)),1e-8));
return mix(texture(window,place).y,textureLod(window,place,max(pixel,level)).y,0.6);
}
vec3 foam_at(vec2 rest){
float out_near=max(abs(rest.x),abs(rest.y))/foam_frames[0].w;
float out_far=max(abs(rest.x),abs(rest.y))/foam_frames[1].w;
vec2 place_far=foam_frames[1].xy + rest*foam_frames[1].z;
vec2 place_near=foam_frames[0].xy + rest*foam_frames[0].z;
float far_cover=spread_cover(foam_far,place_far,0.8);
float near_cover=spread_cover(foam_near,place_near,2.6);
float mean_cover=textureLod(foam_far,vec2(0.5),20.0).y;
float cover=mix(far_cover,mean_cover,smoothstep(0.8,1.0,out_far));
cover=mix(near_cover,cover,smoothstep(0.75,1.0,out_near));
vec2 place=break_up_axes*rest,far_place=break_up_places[1] + place/break_up_larger;
vec2 along=dFdx(place),across=dFdy(place);
float pixel=sqrt(max(dot(along,along),dot(across,across)))*float(textureSize(break_up,0).x);
vec2 fine=(texture(break_up,break_up_places[0] + place).xy - vec2(0.5,0.0))*vec2(8.0,16.0);
vec2 broad=(texture(break_up,far_place).xy - vec2(0.5,0.0))*vec2(8.0,16.0);
float larger=smoothstep(0.5,4.0,log2(max(pixel,1e-4)));
vec2 weights=normalize(vec2(1.0 - 0.85*larger,0.3 + 0.7*larger));
float noise=weights.x*fine.x + weights.y*broad.x;
vec2 lost_each=max(vec2(fine.y,broad.y) - vec2(fine.x,broad.x)*vec2(fine.x,broad.x),0.0);
float lost=min(dot(weights*weights,lost_each),1.0);
float soft=0.45;
float patches=above((threshold_of(cover)*sqrt(1.0 + soft) - noise)/sqrt(lost + soft));
patches=mix(patches,cover,smoothstep(0.5,0.9,lost));
return vec3(cover,cover<2e-4?cover:patches,1.0 + 0.12*noise);
}
`;function an(s){let t=Math.max(s-9,0),e=(Math.max(s,0)+9-t)/500,i=Array.from({length:500},(p,g)=>t+(g+.5)*e),o=.5*Math.min(s,0)**2,n=i.map(p=>p*Math.exp(o-.5*(p-s)**2)),r=n.reduce((p,g)=>p+g),a=[],c=[r],l=i.map(()=>0),h=i.map(()=>1);for(let p=0;p<4;p++){let g=h.map((y,_)=>n[_]*y*y),v=g.reduce((y,_)=>y+_);c[p]=v,a.push(g.reduce((y,_,S)=>y+_*i[S],0)/v);let w=p?v/c[p-1]:0,x=h.map((y,_)=>(i[_]-a[p])*y-w*l[_]);[l,h]=[h,x]}let u=p=>{let g=[1];for(let v=0;v<4;v++){let w=v?c[v]/c[v-1]*g[v-1]:0;g.push((p-a[v])*g[v]-w)}return g},f=[];for(let p=1;p<500;p++){if(h[p-1]*h[p]>0||h[p-1]===0)continue;let[g,v]=[i[p-1],i[p]],w=h[p]>h[p-1];for(let x=0;x<40;x++){let y=.5*(g+v);u(y)[4]>0===w?v=y:g=y}f.push(.5*(g+v))}let m=f.map(p=>1/u(p).slice(0,4).reduce((v,w,x)=>v+w*w*r/c[x],0));return{nodes:f,weights:m}}function Qs(){let s=new Float32Array(488);for(let t=0;t<61;t++){let e=-3+15*t/60,{nodes:i,weights:o}=an(e);s.set(i.map(n=>n-e),4*t),s.set(o,4*(61+t))}return{data:s,width:61,height:2}}var ln=`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
`,Fe=`
uniform sampler2D floating;
uniform float eye_height;
float lifted_eye(){
return max(eye_height,texelFetch(floating,ivec2(0),0).z + 0.45);
}
`;function Js(s){return`${ln}${D(s)}${Ae(s)}${it(s,{spaced:!0})}${Fe}
uniform mat4 view_projection;
uniform sampler2D rings;
uniform vec4 sector;
uniform vec3 beyond;
out vec3 place;
out vec2 rest;
out vec2 mesh_slope;
out vec3 mesh_variance;
out vec2 cell;
const float EARTH=6371e3;
void main(){
int ring=gl_InstanceID + (gl_VertexID & 1),column=gl_VertexID>>1;
vec2 found=texelFetch(rings,ivec2(ring,0),0).xy;
float angle=sector.y + sector.z*(2.0*float(column)/sector.w - 1.0);
float from_apex=found.x + sector.x;
rest=from_apex*vec2(cos(angle),sin(angle)) - sector.x*vec2(cos(sector.y),sin(sector.y));
float across=from_apex*2.0*sector.z/sector.w;
float spacing=pow(max(across,1e-3),0.4)*pow(found.y,0.6);
float distance_=length(rest);
float eye=lifted_eye();
place=vec3(rest,-eye - distance_*distance_/(2.0*EARTH)) + displaced(rest,spacing);
Sums sums=summed(rest,2.0*spacing);
mesh_slope=sums.slope;
mesh_variance=sums.variance + beyond;
cell=vec2(float(column),float(ring));
gl_Position=view_projection*vec4(place,1.0);
}`}var hn=`
uniform sampler2D visible_rules;
float mean_above_zero(float mean,float deviation){
if (mean>6.0*deviation) return mean;
float x=max(mean/deviation,-3.0);
float density=0.39894228*exp(-0.5*x*x);
float t=1.0/(1.0 + 0.2316419*abs(x));
float tail=density*t*(0.31938153 + t*(-0.356563782 + t*(1.781477937 +
t*(-1.821255978 + t*1.330274429))));
return deviation*(density + x*(x>0.0?1.0 - tail:tail));
}
void visible_facets(float mean,float deviation,out vec4 areas,out vec4 weights){
float x=mean/deviation,last=float(textureSize(visible_rules,0).x) - 1.0;
float at=clamp((x - ${(-3).toFixed(1)})/${15 .toFixed(1)},0.0,1.0);
float place=(at*last + 0.5)/(last + 1.0);
areas=max(x,${(-3).toFixed(1)}) + textureLod(visible_rules,vec2(place,0.25),0.0);
areas*=deviation;
weights=textureLod(visible_rules,vec2(place,0.75),0.0);
}
float variance_along(vec3 variance,vec2 direction){
vec2 square=direction*direction;
return dot(variance,vec3(square,2.0*direction.x*direction.y));
}
float shadowing(float cosine,float variance){
float cotangent=cosine/sqrt(max(1.0 - cosine*cosine,1e-6)*2.0*variance);
float gauss=exp(-cotangent*cotangent);
float erfc=2.0*gauss/(2.319*cotangent + sqrt(4.0 + 1.52*cotangent*cotangent));
return max((gauss - 1.7724539*cotangent*erfc)/(3.5449077*cotangent),0.0);
}
float fresnel(float cosine){
float c=clamp(cosine,0.0,1.0),g=sqrt(0.7956 + c*c);
float first=(g - c)/(g + c),second=(c*(g + c) - 1.0)/(c*(g - c) + 1.0);
return 0.5*first*first*(1.0 + second*second);
}
`,Zs=`
struct Surface{
vec2 slope;
vec3 variance;
float jacobian;
};
Surface displaced_surface(Sums sums,vec3 beyond){
float a=1.0 + sums.stretch.x,b=1.0 + sums.stretch.y,c=sums.stretch.z;
float jacobian=max(a*b - c*c,0.15);
vec2 slope=vec2(b*sums.slope.x - c*sums.slope.y,a*sums.slope.y - c*sums.slope.x)/jacobian;
slope*=min(1.0,2.2/max(length(slope),1e-4));
vec3 variance=max(sums.variance + beyond,vec3(2e-5,2e-5,-1.0));
float most=0.98*sqrt(variance.x*variance.y);
variance.z=clamp(variance.z,-most,most);
return Surface(slope,variance,a*b - c*c);
}
`,ti=`
uniform vec3 beyond;
in vec3 place;
in vec2 rest;
in vec2 mesh_slope;
in vec3 mesh_variance;
in vec2 cell;
out vec4 colour;
`;function ei(s,t){return`${E}${P}${t}${D(s)}${it(s)}
uniform vec3 ripple_frame;
${Ys(s)}${hn}${Zs}${ke}${Fe}${ti}
uniform sampler2D sky,light;
uniform vec3 sunward,absorption,backscattering,reflectance;
uniform float wave_height,air_extinction,crest_light;
const float PI=3.14159265;
vec3 mirrored(vec3 to_eye,vec2 slope,float across,float blur,out float share){
vec3 normal=vec3(-slope,1.0)*inversesqrt(1.0 + dot(slope,slope) + across);
float cosine=max(dot(normal,to_eye),0.001);
share=fresnel(cosine);
vec3 ray=2.0*cosine*normal - to_eye;
float up=ray.z;
ray=normalize(vec3(ray.xy,sqrt(up*up + 0.0025)));
float level=log2(max(1.1*blur*float(textureSize(sky,0).x),1.0));
vec3 radiance=textureLod(sky,sky_place(ray),min(level,6.0)).rgb;
return share*radiance*mix(1.0,0.5,smoothstep(0.15,-0.3,up));
}
void main(){
float distance_=length(place);
vec3 to_eye=-place/distance_;
Sums sums=summed(rest);
vec3 unseen=beyond;
add_ripples(rest,sums,unseen);
Surface surface=displaced_surface(sums,unseen);
float level_part=max(length(to_eye.xy),1e-4);
vec2 ahead=to_eye.xy/level_part,aside=vec2(-ahead.y,ahead.x);
float slope_along=dot(surface.slope,ahead),slope_across=dot(surface.slope,aside);
float along=max(variance_along(surface.variance,ahead),1e-6);
float across=max(variance_along(surface.variance,aside),1e-6);
float deviation=sqrt(along),projected_deviation=deviation*level_part;
float middle=to_eye.z - slope_along*level_part;
float area=mean_above_zero(middle,projected_deviation);
float mesh_deviation=level_part*sqrt(max(variance_along(mesh_variance,ahead),1e-6));
float mesh_middle=to_eye.z - dot(mesh_slope,ahead)*level_part;
float mesh_area=max(mean_above_zero(mesh_middle,mesh_deviation),0.01);
float weight=clamp(area/mesh_area,0.2,3.0);
vec4 areas,weights,shares;
visible_facets(middle,projected_deviation,areas,weights);
vec4 facets=slope_along + (middle - areas)/level_part;
vec2 turned=aside*slope_across;
float blur=0.2*deviation + 0.8*to_eye.z*sqrt(across);
vec3 reflected=weights.x*mirrored(to_eye,ahead*facets.x + turned,across,blur,shares.x);
reflected +=weights.y*mirrored(to_eye,ahead*facets.y + turned,across,blur,shares.y);
reflected +=weights.z*mirrored(to_eye,ahead*facets.z + turned,across,blur,shares.z);
reflected +=weights.w*mirrored(to_eye,ahead*facets.w + turned,across,blur,shares.w);
float share=dot(weights,shares);
vec3 sun_light=texelFetch(light,ivec2(0),0).rgb,sky_light=texelFetch(light,ivec2(1,0),0).rgb;
vec3 glitter=vec3(0.0);
vec3 halfway=normalize(sunward + to_eye);
if (halfway.z>0.02 && sunward.z>-0.01){
vec3 variance=surface.variance + vec3(5.4e-6,5.4e-6,0.0);
float determinant=variance.x*variance.y - variance.z*variance.z;
vec2 off=-halfway.xy/halfway.z - surface.slope;
float square=(variance.y*off.x*off.x - 2.0*variance.z*off.x*off.y +
variance.x*off.y*off.y)/determinant;
float probability=exp(-0.5*square)/(2.0*PI*sqrt(determinant));
float upright=halfway.z*halfway.z;
float sun_variance=variance_along(mesh_variance,normalize(sunward.xy + 1e-5));
float lit=1.0/(1.0 + shadowing(max(sunward.z,0.005),sun_variance));
glitter=sun_light*fresnel(dot(to_eye,halfway))*probability*lit/
(4.0*upright*upright*mesh_area);
}
vec3 falling=sun_light*max(sunward.z,0.0) + sky_light;
vec3 body=reflectance*falling;
vec3 facet=normalize(vec3(-surface.slope,1.0));
float crest=clamp(0.5 + (place.z + lifted_eye())/wave_height,0.0,1.4);
if (crest_light>0.0){
vec2 glare=normalize(sunward.xy + 1e-5);
float against=pow(max(-dot(glare,ahead),0.0)*0.92 + 0.08,3.0)*(1.0 - 0.7*to_eye.z);
float tilt=clamp(0.55 - 0.5*dot(facet,sunward) + 0.4*length(surface.slope),0.0,1.0);
float way=mix(10.0,2.2,clamp(crest,0.0,1.0));
vec3 through=exp(-(absorption + backscattering)*way)*backscattering/(backscattering + 0.02);
float steep=smoothstep(0.05,0.5,length(surface.slope));
body +=crest_light*(sun_light*against*(0.3 + 0.7*steep) + 0.15*sky_light)*through*tilt*tilt*crest*0.3;
}
vec3 radiance=weight*(reflected + (1.0 - share)*body) + glitter;
vec3 foam=foam_at(rest);
float sunlit=smoothstep(-0.02,0.06,sunward.z)*(0.3 + 0.7*max(dot(facet,sunward),0.0));
vec3 white=0.55/PI*foam.z*(sun_light*sunlit + sky_light);
vec3 bubbles=body + 0.12/PI*falling*exp(-(absorption + backscattering)*5.0);
radiance=mix(radiance,mix(radiance,bubbles,0.75),smoothstep(0.0,0.6,foam.x)*(1.0 - share)*0.8);
radiance=mix(radiance,white,foam.y*0.9);
vec3 haze_light=textureLod(sky,sky_place(normalize(vec3(-to_eye.xy,0.02))),1.0).rgb;
radiance=mix(radiance,haze_light,1.0 - exp(-distance_*air_extinction));
colour=shown(radiance,texelFetch(light,ivec2(3,0),0).x);
}`}function si(s){return`${E}${D(s)}${it(s)}${Zs}${ke}${Fe}${ti}
uniform sampler2D colour_maps; // one map a row
uniform int view;
uniform vec4 shown_range; // lowest and highest value, row of the map, rows
uniform float tile_counts[${s}];

vec3 mapped(float value) {
  float at = clamp((value - shown_range.x) / (shown_range.y - shown_range.x), 0.0, 1.0);
  return textureLod(colour_maps, vec2((at * 255.0 + 0.5) / 256.0, (shown_range.z + 0.5) / shown_range.w), 0.0).rgb;
}

float line(vec2 at, float width) {
  vec2 near = abs(fract(at - 0.5) - 0.5) / max(fwidth(at), 1e-6);
  return 1.0 - smoothstep(width - 0.5, width + 0.5, min(near.x, near.y));
}

// Dense lines turn into a grey of their own instead of noise.
float fading(vec2 at) {
  vec2 rate = fwidth(at);
  return 1.0 - smoothstep(0.25, 0.6, max(rate.x, rate.y));
}

void main() {
  Sums sums = summed(rest);
  Surface surface = displaced_surface(sums, beyond);
  vec3 facet = normalize(vec3(-surface.slope, 1.0));
  float height = place.z + lifted_eye() + dot(rest, rest) / (2.0 * 6371e3);
  vec3 found;
  if (view == 1) found = mapped(height);
  else if (view == 2) found = mapped(length(surface.slope));
  else if (view == 3) found = 0.5 + 0.5 * facet;
  else if (view == 4) found = mapped(surface.jacobian);
  else if (view == 5) found = mapped(foam_at(rest).x);
  else if (view == 6) found = mapped(sqrt(surface.variance.x + surface.variance.y));
  else if (view == 7) {
    // The borders of the tiles, one hue a tile, over the heights.
    found = mix(vec3(dot(mapped(height), vec3(0.33))), vec3(0.35), 0.3);
    const vec3 HUES[4] = vec3[4](vec3(0.95, 0.75, 0.2), vec3(0.3, 0.75, 0.95), vec3(0.95, 0.45, 0.55), vec3(0.55, 0.85, 0.45));
    for (int i = 0; i < ${s}; i++) {
      vec2 at = tile_place(i, rest);
      found = mix(found, HUES[i & 3], line(at, 1.0) * fading(at));
    }
  } else {
    float edges = max(line(cell, 0.6), line(vec2(cell.x + cell.y), 0.6));
    vec3 plain = mapped(height) * (0.55 + 0.45 * facet.z);
    found = mix(plain, vec3(0.05), 0.8 * edges * fading(cell));
  }
  colour = vec4(found, 1.0);
}`}function ii(s){return`${E}${D(s)}${Ae(s)}${it(s,{spaced:!0})}
uniform vec2 places[2]; // from the eye [m]
uniform float spacings[2]; // size of what floats: it does not feel shorter waves
layout(location = 0) out vec4 position;
layout(location = 1) out vec4 tilt;

void main() {
  int which = int(gl_FragCoord.x);
  vec2 wanted = places[which], rest = wanted;
  float spacing = spacings[which];
  vec3 moved = vec3(0.0);
  for (int i = 0; i < 6; i++) {
    moved = displaced(rest, spacing);
    rest += 0.8 * (wanted - rest - moved.xy);
  }
  position = vec4(rest + moved.xy, moved.z, 1.0);
  tilt = vec4(summed(rest, spacing).slope, 0.0, 1.0);
}`}var un=.9,fn=.4,Bt=class{constructor(t){this.gl=t;let e={format:"RGBA16F",width:2,height:1,wrap:"clamp"};this.target=M(t,[b(t,e),b(t,e)]),this.programs=new Map}update(t,e,i){let{gl:o,programs:n}=this;n.has(e)||n.set(e,T(o,ii(e)));let r={...t,places:[[0,0],i],spacings:[fn,un]};A(o,n.get(e),r,this.target)}get position(){return this.target.textures[0]}get tilt(){return this.target.textures[1]}dispose(){for(let t of this.programs.values())t.dispose();this.target.dispose()}},Ut=class{constructor(t){this.gl=t,this.program=T(t,qs($),Us),this.place=null}placeFrom(t){let{forward:e}=t.axes(),i=this.place?Math.hypot(this.place[0]-t.east,this.place[1]-t.north):1/0,o=Math.max(14,1.6*t.height);if(i>12*o){let n=Math.hypot(e[0],e[1])||1,r=.18*o;this.place=[t.east+(o*e[0]+r*e[1])/n,t.north+(o*e[1]-r*e[0])/n]}return[this.place[0]-t.east,this.place[1]-t.north]}remove(){this.place=null}draw(t){let{gl:e}=this,i=2*(Se+1);et(e,this.program,t,null,e.TRIANGLE_STRIP,i,Te-1)}dispose(){this.program.dispose()}};var pn=[[.19,.137],[-.15,.217]],mn=.065,gn=.21;function qt(s){return s-Math.floor(s)}function Gt(s,t,e){let i=[],o=[],n=[],r=[],a=Math.max(...s.map(f=>f.lx));for(let{nx:f,ny:m,lx:p,ly:g}of s){let v=p===a?mn:gn,w=[.5/f,.5/m],x=Math.max(p,g),y=[],_=[],S=[];for(let[R,F]of pn){let z=Math.hypot(R,F),dt=v*x/(2*Math.PI*z),X=[-F/z*dt,R/z*dt];y.push(...X),_.push(2*Math.PI*R/x,2*Math.PI*F/x),S.push(2*Math.PI*qt((R*t+F*e)/x)),w[0]-=X[0]/p,w[1]-=X[1]/g}i.push([qt(t/p+w[0]),qt(e/g+w[1]),1/p,1/g]),o.push(_),n.push(y),r.push(S)}let{lx:c,ly:l}=s.at(-1),h=Math.max(c,l);return{ripple_frame:[...[.8*t-.6*e,.6*t+.8*e].map(f=>qt(5.3*f/h)),1/h],tile_frames:i,shear_waves:o,shear_shifts:n,shear_phases:r,displacement_maps:s.map(({maps:f})=>f.displacement),slope_maps:s.map(({maps:f})=>f.slopes),moment_maps:s.map(({maps:f})=>f.moments)}}var vn=[256,2048],xn=[0,.2],oi=11,ni=6.7,ot=4;function ri(s){let t=s|0;return t=Math.imul(t^t>>>16,2146121005),t=Math.imul(t^t>>>15,2221713035),(t^t>>>16)>>>0}function Ne(s,t,e,i){let o=(s%e+e)%e,n=(t%e+e)%e;return ri(ri(o+7919*i)+n)/2**32}function Ht(s,t,e,i){let[o,n]=[Math.floor(s*e),Math.floor(t*e)],r=f=>f*f*(3-2*f),[a,c]=[r(s*e-o),r(t*e-n)],l=(f,m)=>Ne(o+f,n+m,e,i),h=l(0,0)+a*(l(1,0)-l(0,0)),u=l(0,1)+a*(l(1,1)-l(0,1));return h+c*(u-h)}function Ie(s,t,e,i){let[o,n]=[Math.floor(s*e),Math.floor(t*e)],[r,a]=[9,9];for(let c=o-1;c<=o+1;c++)for(let l=n-1;l<=n+1;l++){let h=c+Ne(c,l,e,i)-s*e,u=l+Ne(c,l,e,i+1)-t*e,f=Math.hypot(h,u);f<r?[r,a]=[f,r]:a=Math.min(a,f)}return 1-Math.min(a-r,1)}function ai(s){let t=[-39.69683028665376,220.9460984245205,-275.9285104469687];t.push(138.357751867269,-30.66479806614716,2.506628277459239);let e=[-54.47609879822406,161.5858368580409,-155.6989798598866];e.push(66.80131188771972,-13.28068155288572,1);let i=[-.007784894002430293,-.3223964580411365,-2.400758277161838];i.push(-2.549732539343734,4.374664141464968,2.938163982698783);let o=[.007784695709041462,.3224671290700398,2.445134137142996,3.754408661907416,1],n=(a,c)=>a.reduce((l,h)=>l*c+h,0);if(s>.5)return-ai(1-s);if(s<.02425){let a=Math.sqrt(-2*Math.log(s));return n(i,a)/n(o,a)}let r=s-.5;return r*n(t,r*r)/n(e,r*r)}function wn(s){let t=new Float64Array(s*s);for(let o=0;o<s;o++)for(let n=0;n<s;n++){let[r,a]=[(n+.5)/s,(o+.5)/s],c=.05*(Ht(r,a,7,11)-.5),l=.05*(Ht(r,a,7,12)-.5),[h,u]=[r+c,a+l],f=Ie(h,u,11,1)**2,m=Ie(h+c,u,27,3)**2,p=Ie(h,u+c,61,5),g=Ht(r,a,4,7)+.6*Ht(r,a,9,8);t[o*s+n]=.34*f+.3*m+.2*p+.22*g}let e=Array.from(t.keys()).sort((o,n)=>t[o]-t[n]),i=new Float32Array(s*s);return e.forEach((o,n)=>i[o]=ai((n+.5)/(s*s))),i}function yn(s){let t=new Uint8Array(4*s*s);return wn(s).forEach((e,i)=>{let o=Math.min(Math.max(e,-ot),ot),n=Math.round(255*(.5+o/(2*ot))),r=(n/255-.5)*2*ot;t.set([n,Math.round(255*r*r/ot**2),0,255],4*i)}),t}var Le=class{constructor(t,e,i){Object.assign(this,{gl:t,size:e,samples:i,cell:e/i});let o={format:"RGBA16F",width:i,height:i,filter:"linear"};this.targets=[0,1].map(()=>M(t,[b(t,{...o,mips:!0})])),this.corner=[0,0],this.fresh=!0,this.pending=0}advance(t,e,i,[o,n],r,a){let c=[o,n].map(m=>Math.floor(m/this.cell)-this.samples/2),l=Math.max(...c.map((m,p)=>Math.abs(m-this.corner[p])));if(this.pending+=r,this.pending<a&&l<this.samples/32&&!this.fresh)return;let h=this.pending;this.pending=0;let[u,f]=this.targets;A(this.gl,t,{...e,before:u.textures[0],corner:c,corner_before:this.corner,corner_place:[o,n].map((m,p)=>(c[p]+.5)*this.cell-m),cell:this.cell,seconds:h,decay:i.decay,threshold:i.threshold,strength:i.strength,fresh:this.fresh},f),f.textures[0].generateMips(),this.targets=[f,u],this.corner=c,this.fresh=!1}frame([t,e]){return[...[t,e].map(o=>o/this.size-Math.floor(o/this.size)),1/this.size,this.size/2-2*this.cell]}get map(){return this.targets[0].textures[0]}dispose(){for(let t of this.targets)t.dispose()}},jt=class{constructor(t,e,i,o){this.gl=t,this.windows=vn.map((n,r)=>new Le(t,n,e[r])),this.breakUp=b(t,{format:"RGBA8",width:i,height:i,data:yn(i),filter:"linear",mips:!0,anisotropy:o}),this.breakUp.generateMips(),this.steps=new Map}restart(){for(let t of this.windows)t.fresh=!0}advance(t,e,i){let{foam:o}=t.document;if(!o||!(i>0))return;let n=t.tiles.length;this.steps.has(n)||this.steps.set(n,T(this.gl,Ks(n)));let r=Gt(t.tiles,...e);this.windows.forEach((a,c)=>a.advance(this.steps.get(n),r,o,e,i,xn[c]))}uniforms([t,e],i){let o=1+Math.min((i?.speed??0)/14,2),n=(i?.direction??0)*Math.PI/180,[r,a]=[Math.cos(n)/oi,Math.sin(n)/oi],c=[[r/o,a/o],[-a,r]],l=c.map(([u,f])=>u*t+f*e),h=u=>l.map(f=>f/u-Math.floor(f/u));return{foam_near:this.windows[0].map,foam_far:this.windows[1].map,foam_frames:this.windows.map(u=>u.frame([t,e])),break_up:this.breakUp,break_up_axes:[c[0][0],c[1][0],c[0][1],c[1][1]],break_up_places:[h(1),h(ni)],break_up_larger:ni}}dispose(){for(let t of[...this.windows,...this.steps.values(),this.breakUp])t.dispose()}};var ci=Math.PI/180;function nt(s,t){let[e,i]=[s*ci,t*ci];return[Math.cos(e)*Math.cos(i),Math.cos(e)*Math.sin(i),Math.sin(e)]}var B=class{constructor(t,e){this.gl=t,this.clearProgram=T(t,Hs),this.mapProgram=T(t,js),this.lightProgram=T(t,Rs(Vs)),this.background=T(t,Xs($),Ws);let i={format:"RGBA16F",width:e,height:e};this.map=b(t,{...i,filter:"linear",wrap:"clamp",mips:!0}),this.mapTarget=M(t,[this.map]);let o={format:"RGBA16F",width:e/2,height:e/2};if(this.clearMap=b(t,{...o,filter:"linear",wrap:"clamp"}),this.clearTarget=M(t,[this.clearMap]),this.light=b(t,{format:"RGBA16F",width:4,height:1,wrap:"clamp"}),this.lightTarget=M(t,[this.light]),!this.mapTarget.complete)throw this.dispose(),new Error("this graphics processor cannot draw into half-float textures");this.key=""}update({sun:t,haze:e,clouds:i}){let o=[...t,e,i].join();if(o===this.key)return;this.key=o;let n={sun:t,haze:e,clouds:i,sky:this.map,clear_map:this.clearMap},r=(a,c)=>A(this.gl,a,{...n,samples:c.width},c);r(this.clearProgram,this.clearTarget),r(this.mapProgram,this.mapTarget),this.map.generateMips(),r(this.lightProgram,this.lightTarget)}drawBackground({sun:t,clouds:e,plain:i,exposureFactor:o,linearLight:n},r){A(this.gl,this.background,{rays:r.rays,clear_map:this.clearMap,light:this.light,sunward:t,clouds:e,plain:i??[-1,-1,-1],exposure_factor:o,linear_light:n})}dispose(){for(let t of[this.clearProgram,this.mapProgram,this.lightProgram,this.background])t?.dispose();this.clearTarget?.dispose(),this.mapTarget?.dispose(),this.lightTarget?.dispose()}};var li=[.09,.09,.1];function hi([s,t,e]){let i=(s+.3963377774*t+.2158037573*e)**3,o=(s-.1055613458*t-.0638541728*e)**3,n=(s-.0894841775*t-1.291485548*e)**3;return[4.0767416621*i-3.3077115913*o+.2309699292*n,-1.2684380046*i+2.6097574011*o-.3413193965*n,-.0041960863*i-.7034186147*o+1.707614701*n]}function bn(s,t,e){let i=e*Math.PI/180,o=c=>{let l=c*t;return[s,l*Math.cos(i),l*Math.sin(i)]},n=c=>hi(o(c)).every(l=>l>0&&l<1);if(n(1))return o(1);let[r,a]=[0,1];for(let c=0;c<24;c++){let l=.5*(r+a);n(l)?r=l:a=l}return o(r)}function Oe(s,t){let e=t*(s.length-1),i=Math.min(Math.floor(e),s.length-2);return s[i]+(e-i)*(s[i+1]-s[i])}function $e(s,t,e,i){let n=Array.from({length:2001},(c,l)=>bn(Oe(s,l/2e3),Oe(t,l/2e3),Oe(e,l/2e3))),r=[0];for(let c=1;c<=2e3;c++)r.push(r[c-1]+Math.hypot(...n[c].map((l,h)=>l-n[c-1][h])));let a=1;return Array.from({length:i},(c,l)=>{let h=r[2e3]*l/(i-1);for(;a<2e3&&r[a]<h;)a++;let u=Math.min((h-r[a-1])/(r[a]-r[a-1]||1),1);return n[a].map((f,m)=>n[a-1][m]+u*(f-n[a-1][m]))})}function _n(s,t){return[...$e(s.lightness,s.chroma,s.hue,128),...$e(t.lightness,t.chroma,t.hue,128).reverse()]}var ui={sequential:()=>$e([.2,.96],[.09,.13,.14,.14,.15],[300,265,215,150,105],256),twoSided:()=>_n({lightness:[.32,.96],chroma:[.13,.14,0],hue:[262,235,220]},{lightness:[.32,.96],chroma:[.12,.15,0],hue:[25,45,80]})},rt=Object.keys(ui);function En(s){return ui[s]()}function Tn(s){let t=Math.min(Math.max(s,0),1);return Math.round(255*(t<.0031308?12.92*t:1.055*t**(1/2.4)-.055))}function Sn(s){return En(s).map(t=>hi(t).map(Tn))}function fi(){let s=new Uint8Array(1024*rt.length);return rt.forEach((t,e)=>Sn(t).forEach((i,o)=>s.set([...i,255],4*(256*e+o)))),{data:s,width:256,height:rt.length}}var Pe=[{name:"sea",label:"sea"},{name:"height",label:"height",unit:"m",map:"twoSided"},{name:"slopes",label:"slope",unit:"",map:"sequential",range:()=>[0,.8]},{name:"normals",label:"normals",unit:""},{name:"jacobian",label:"Jacobian",unit:"",map:"twoSided",range:()=>[0,2]},{name:"foam",label:"foam coverage",unit:"",map:"sequential",range:()=>[0,1]},{name:"roughness",label:"rms slope below a pixel",map:"sequential",range:Mn},{name:"tiles",label:"borders of the tiles",unit:"m",map:"twoSided"},{name:"wireframe",label:"mesh over height",unit:"m",map:"twoSided"}];function Vt(s){let t=Pe.findIndex(e=>e.name===s);if(t<0){let e=Pe.map(i=>i.name).join(", ");throw new RangeError(`view must be one of ${e}, got ${JSON.stringify(s)}`)}return t}function at(s){let{realised:t,specified:e}=s?.statistics??{};return Math.max(t?.hs??e?.hs??1,.02)}function Mn(s){let t=s?.slope_variance?.total??[.03,.03,0];return[0,Math.max(1.1*Math.sqrt(t[0]+t[1]),.1)]}function An(s,t){if(s.range)return s.range(t);let e=at(t);return[-e,e]}function di(s,t){let e=Pe[Vt(s)],i=e.map?An(e,t):[0,1],o=Math.max(rt.indexOf(e.map),0);return{view:Vt(s),shown_range:[...i,o,rt.length]}}var kn=[.002,.002,0],Rn=6e-5;function Fn(s){let t=s?.bounds?.displacement,e=1.6*at(s);return Math.max(Number.isFinite(t)?t:e,.2)}function In(s,{data:t,width:e,height:i}){return b(s,{...{format:"RGBA16F",width:e,height:i,wrap:"clamp"},data:Pt(t),filter:"linear"})}var Wt=class{constructor(t,{columns:e,rings:i}){this.gl=t,this.columns=e,this.rings=i,this.ringTexture=b(t,{format:"RG32F",width:i,height:1,wrap:"clamp"}),this.visibleRules=In(t,Qs()),this.programs=new Map,this.colourMaps=null}programFor(t,e){let i=`${t} ${e}`;if(!this.programs.has(i)){let o=e?si(t):ei(t,$);this.programs.set(i,T(this.gl,o,Js(t)))}return this.programs.get(i)}draw(t,e,i,o,n){let{gl:r}=this,{document:a,tiles:c}=t,l=Fn(a),h=wt(e,i,l),u=Math.max(e.height,.35*at(a));this.ringTexture.upload(yt(h.near,h.far,u,this.rings));let f=o.view!=="sea",m=zt(o.chlorophyll),p={...n,rings:this.ringTexture,visible_rules:this.visibleRules,sector:[h.apex,h.middle,h.half,this.columns],beyond:a.slope_variance?.beyond??kn,absorption:m.absorption,backscattering:m.backscattering,reflectance:Ct(m),wave_height:at(a),air_extinction:Rn*o.haze,crest_light:o.crestLight?1:0,...f?this.falseColours(o.view,a):{}};et(r,this.programFor(c.length,f),p,null,r.TRIANGLE_STRIP,2*(this.columns+1),this.rings-1)}falseColours(t,e){return this.colourMaps??=b(this.gl,{...fi(),format:"RGBA8",filter:"linear",wrap:"clamp"}),{...di(t,e),colour_maps:this.colourMaps}}dispose(){for(let t of[...this.programs.values(),this.ringTexture,this.visibleRules])t.dispose();this.colourMaps?.dispose()}};var pi={low:{columns:96,rings:112,sky:256,foam:[128,256],noise:128,anisotropy:2,pixelRatio:1},medium:{columns:192,rings:224,sky:512,foam:[512,1024],noise:256,anisotropy:8,pixelRatio:1},high:{columns:384,rings:384,sky:512,foam:[1024,2048],noise:512,anisotropy:16,pixelRatio:2}},Xt={sunElevation:28,sunAzimuth:60,chlorophyll:.3,haze:1,clouds:.45,exposure:0,view:"sea",buoy:!1,crestLight:!0},ct=class{constructor(t,{quality:e="medium"}={}){if(this.gl=t,this.quality=typeof e=="string"?pi[e]:e,!this.quality){let a=Object.keys(pi).join(", ");throw new RangeError(`quality must be one of ${a}, got ${JSON.stringify(e)}`)}t.getExtension("EXT_color_buffer_float")??t.getExtension("EXT_color_buffer_half_float");let{sky:i,foam:o,noise:n,anisotropy:r}=this.quality;this.sky=new B(t,i),this.foam=new jt(t,o,n,r),this.floating=new Bt(t),this.water=new Wt(t,this.quality),this.buoy=null,this.filtered=new WeakSet,this.vertexArray=t.createVertexArray()}advanceFoam(t,e,i){this.prepare(),this.foam.advance(t,[e.east,e.north],i)}restartFoam(){this.foam.restart()}render(t,e,i,o,n,{target:r=null,linear:a=!1}={}){let{gl:c}=this,l={...Xt,...i};Vt(l.view),this.prepare(),this.filter(t.tiles);let h=nt(l.sunElevation,l.sunAzimuth),u={sun:h,haze:l.haze,clouds:l.clouds};this.sky.update(u);let f=Gt(t.tiles,e.east,e.north);l.buoy?this.buoy??=new Ut(c):this.buoy?.remove();let m=l.buoy?this.buoy.placeFrom(e):[0,0];this.floating.update(f,t.tiles.length,m),c.bindFramebuffer(c.FRAMEBUFFER,r?.handle??null),c.viewport(0,0,o,n),c.depthMask(!0),c.clearDepth(1),c.clear(c.DEPTH_BUFFER_BIT),c.enable(c.DEPTH_TEST),c.depthFunc(c.LESS);let p=e.matrices(o/n),g=tt(l.exposure),v={...f,...this.foam.uniforms([e.east,e.north],t.document.wind),floating:this.floating.position,floating_tilt:this.floating.tilt,eye_height:e.height,view_projection:p.viewProjection,sky:this.sky.map,light:this.sky.light,sunward:h,exposure_factor:g,linear_light:a};l.buoy&&l.view==="sea"&&this.buoy.draw(v),this.water.draw(t,e,o/n,l,v),c.depthFunc(c.LEQUAL);let w=l.view==="sea"?null:li;this.sky.drawBackground({...u,plain:w,exposureFactor:g,linearLight:a},p),c.disable(c.DEPTH_TEST)}prepare(){let{gl:t}=this;t.bindVertexArray(this.vertexArray);for(let e of[t.DEPTH_TEST,t.BLEND,t.CULL_FACE,t.SCISSOR_TEST])t.disable(e);t.colorMask(!0,!0,!0,!0)}filter(t){let{gl:e}=this,i=e.getExtension("EXT_texture_filter_anisotropic");if(!i)return;let o=e.getParameter(i.MAX_TEXTURE_MAX_ANISOTROPY_EXT),n=Math.min(this.quality.anisotropy,o);for(let{maps:r}of t)for(let a of Object.values(r))this.filtered.has(a)||(e.bindTexture(e.TEXTURE_2D,a.handle),e.texParameterf(e.TEXTURE_2D,i.TEXTURE_MAX_ANISOTROPY_EXT,n),this.filtered.add(a))}dispose(){for(let t of[this.sky,this.foam,this.floating,this.water,this.buoy])t?.dispose();this.gl.deleteVertexArray(this.vertexArray)}};var Nn=`
vec2 phasor(float turn){
float quarter=floor(4.0*turn + 0.5);
float x=turn - 0.25*quarter;
float q=x*x;
float s=x*(SINE);
float c=1.0 + q*(COSINE);
int quadrant=int(quarter) & 3;
vec2 turned=(quadrant & 1)==0?vec2(c,s):vec2(-s,c);
return (quadrant & 2)==0?turned:-turned;
}`.replace("SINE","6.2831853 + q * (-41.341663 + q * (81.591983 + q * -75.369649))").replace("COSINE","-19.739209 + q * (64.939363 + q * (-85.447456 + q * 59.362561))"),Ln=`
vec2 phasor(float turn){
return vec2(cos(6.2831853*turn),sin(6.2831853*turn));
}`;function lt(s){return s==="platform"?Ln:Nn}function mi(s="polynomial"){return`${E}${lt(s)}
uniform sampler2D h0_to,h0_from,wave_to,wave_from;
uniform ivec2 samples;
uniform vec2 wavenumber_step;
uniform uint tick,mask;
uniform float turns_per_tick,scale_to,scale_from;
uniform vec4 lifts;
layout(location=0) out vec4 first;
layout(location=1) out vec4 second;
vec2 multiply(vec2 a,vec2 b){
return vec2(a.x*b.x - a.y*b.y,a.x*b.y + a.y*b.x);
}
vec2 times_i(vec2 a){
return vec2(-a.y,a.x);
}
vec2 height_of(vec4 h0,vec2 phase){
return multiply(h0.xy,vec2(phase.x,-phase.y)) + multiply(h0.zw,phase);
}
void main(){
ivec2 at=ivec2(gl_FragCoord.xy);
vec2 wave=texelFetch(wave_to,at,0).xy;
uint ticks=(uint(wave.x)*tick) & mask;
vec2 phase=phasor(float(ticks)*turns_per_tick);
vec2 height=scale_to*height_of(texelFetch(h0_to,at,0),phase);
vec2 potential=height*wave.y;
if (scale_from>0.0){
vec2 earlier=scale_from*height_of(texelFetch(h0_from,at,0),phase);
height +=earlier;
potential +=earlier*texelFetch(wave_from,at,0).y;
}
ivec2 whole=ivec2(2*at.x<samples.x?at.x:at.x - samples.x,
2*at.y<samples.y?at.y:at.y - samples.y);
vec2 k=vec2(whole)*wavenumber_step;
vec2 displace_x=times_i(k.x*potential),displace_y=times_i(k.y*potential);
vec2 slope_x=times_i(k.x*height),slope_y=times_i(k.y*height);
vec2 stretch_xx=-k.x*k.x*potential;
vec2 stretch_xy=-k.x*k.y*potential;
vec2 stretch_yy=-k.y*k.y*potential;
first=vec4(displace_x + lifts.x*times_i(displace_y),height + lifts.y*times_i(stretch_xy));
second=vec4(slope_x + lifts.z*times_i(slope_y),stretch_xx + lifts.w*times_i(stretch_yy));
}`}var U=64,gi=["still","moved","normal"],ze=`#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
${lt("polynomial")}
const float EARTH_RADIUS=6371e3;
uniform mat4 view_projection;
uniform sampler2D rings;
uniform int columns,waves;
uniform float middle,half_angle,apex,height,fade,choppiness;
uniform vec4 wavenumber[${U}];
uniform vec4 wave[${U}];
out vec2 still;
out vec3 moved;
out vec3 normal;
out float rough;
float leading(float value){
return uintBitsToFloat(floatBitsToUint(value) & 0xfffff000u);
}
float turns(vec2 k,float position){
float large=leading(position),small=position - large;
return fract(k.x*large) + (k.x*small + k.y*position);
}
void main(){
ivec2 node=ivec2(gl_VertexID % columns,gl_VertexID/columns);
vec2 ring=texelFetch(rings,ivec2(node.y,0),0).xy;
float share=float(node.x)/float(columns - 1);
float angle=middle + half_angle*(2.0*share - 1.0);
vec2 ahead=vec2(cos(middle),sin(middle));
float reach=ring.x + apex;
still=vec2(cos(angle),sin(angle))*reach - ahead*apex;
float across=2.0*half_angle*reach/float(columns - 1);
float spacing=fade*pow(max(across,1e-3),0.3)*pow(ring.y,0.7);
moved=vec3(0.0);
rough=0.0;
vec3 along_x=vec3(1.0,0.0,0.0),along_y=vec3(0.0,1.0,0.0);
for (int i=0;i<waves;i++){
vec4 k=wavenumber[i];
vec2 turned=phasor(wave[i].w + turns(k.xy,still.x) + turns(k.zw,still.y));
vec2 vector=vec2(k.x + k.y,k.z + k.w);
float number=length(vector);
float kept=1.0 - smoothstep(0.2,0.45,spacing*number);
float amplitude=kept*wave[i].x,sharp=choppiness*amplitude*wave[i].y;
vec2 unit=vector/number,gradient=6.2831853*vector;
float steepness=wave[i].x*6.2831853*number;
rough +=0.25*(1.0 - kept*kept)*steepness*steepness;
moved +=vec3(-sharp*unit*turned.y,amplitude*turned.x);
vec3 slope=vec3(-sharp*unit*turned.x,-amplitude*turned.y);
along_x +=gradient.x*slope;
along_y +=gradient.y*slope;
}
vec3 upward=cross(along_x,along_y);
float size=length(upward);
normal=size>0.0?upward/size:vec3(0.0,0.0,1.0);
vec3 seen=vec3(still,-height - dot(still,still)/(2.0*EARTH_RADIUS)) + moved;
gl_Position=view_projection*vec4(seen,1.0);
}`,Ce=`${E}${P}${$}
const float PI=3.14159265;
uniform sampler2D noise,sky,light;
uniform float height,ambient,diffuse,specular,shininess,noise_amplitude,noise_frequency;
uniform float air_extinction;
uniform vec2 noise_start;
uniform vec3 sunward,albedo;
in vec2 still;
in vec3 moved;
in vec3 normal;
in float rough;
out vec4 pixel;
vec3 turn_normal(vec2 angle,vec3 n){
float c=cos(angle.x),s=sin(angle.x);
n.yz=vec2(n.y*c - n.z*s,n.y*s + n.z*c);
c=cos(angle.y);
s=sin(angle.y);
n.xz=vec2(n.x*c + n.z*s,n.z*c - n.x*s);
return normalize(n);
}
vec3 mirrored_sky(vec3 n,vec3 to_eye,float variance){
float deviation=sqrt(variance);
float level_part=max(length(to_eye.xy),1e-4);
float steepness=level_part/max(to_eye.z,0.02);
float lean=variance*steepness/(1.0 + 1.2*deviation*steepness);
n=normalize(n + n.z*vec3(to_eye.xy/level_part*lean,0.0));
float cosine=max(dot(n,to_eye),0.01);
float share=0.02 + 0.98*pow(1.0 - cosine,5.0*exp(-2.69*deviation))/
(1.0 + 22.7*pow(deviation,1.5));
vec3 ray=2.0*cosine*n - to_eye;
float dim=mix(1.0,0.5,smoothstep(0.02,-0.3,ray.z));
ray=normalize(vec3(ray.xy,abs(ray.z) + 0.01));
float level=log2(max(2.0*deviation*float(textureSize(sky,0).x),1.0));
return dim*share*textureLod(sky,sky_place(ray),min(level,6.0)).rgb;
}
void main(){
vec2 at=noise_start + still*noise_frequency;
const mat2 TURN=mat2(0.8,0.6,-0.6,0.8);
vec2 wide=TURN*at*0.37 + 0.37;
vec2 angle=texture(noise,at).xy + texture(noise,wide).xy*TURN;
vec3 n=turn_normal(0.5*noise_amplitude*angle,normalize(normal));
float texels=float(textureSize(noise,0).x)*max(length(dFdx(at)),length(dFdy(at)));
float lost=0.05*noise_amplitude*noise_amplitude*clamp(log2(texels)/6.0,0.0,1.0);
vec3 way=vec3(-still,height) - moved;
float far=length(way);
vec3 to_eye=way/far;
vec3 sun_light=texelFetch(light,ivec2(0,0),0).rgb;
vec3 sky_light=texelFetch(light,ivec2(1,0),0).rgb;
float lit=dot(n,sunward);
float glint=0.0;
if (lit>0.0){
float wider=1.0 + shininess*(lost + rough);
float mirrored=max(dot(to_eye,2.0*n*lit - sunward),0.0);
glint=pow(mirrored,shininess/wider)/wider;
}
vec3 everywhere=albedo/PI*(sun_light*max(sunward.z,0.0) + sky_light);
vec3 radiance=ambient*(everywhere + mirrored_sky(n,to_eye,2e-4 + rough + lost));
radiance +=diffuse*max(lit,0.0)*albedo/PI*sun_light;
radiance +=specular*glint*GLINT*sun_light;
vec3 haze=textureLod(sky,sky_place(normalize(vec3(-to_eye.xy,0.02))),1.0).rgb;
radiance=mix(radiance,haze,1.0 - exp(-far*air_extinction));
pixel=shown(radiance,texelFetch(light,ivec2(3,0),0).x);
}`.replace("GLINT","1.2");var De=2*Math.PI,On=6e-5,vi=256,$n=3,xi={ambient:1,diffuse:.6,specular:.5,shininess:180,noiseAmplitude:.3,noiseFrequency:1,choppiness:1};function ht(s){return s-Math.floor(s)}function wi(s){let t=new Uint32Array(Float32Array.of(s).buffer);return t[0]&=4294963200,new Float32Array(t.buffer)[0]}function Pn(s,t,e,i){let o=s.kx.length;if(o>U)throw new RangeError(`a few-wave model must have at most ${U} waves, got ${o}`);let n=new Float32Array(4*U),r=new Float32Array(4*U);for(let a=0;a<o;a++){let[c,l]=[s.kx[a]/De,s.ky[a]/De],[h,u]=[wi(c),wi(l)];n.set([h,c-h,u,l-u],4*a);let f=s.cycles[a]*t%s.ticks/s.ticks,m=ht(c*e)+ht(l*i)-f-s.phase[a]/De;r.set([s.amplitude[a],s.sharpness[a],0,ht(m)],4*a)}return{wavenumber:n,wave:r,count:o}}function zn(s,t){let e=0;return s.amplitude.forEach((i,o)=>{e+=Math.abs(i)*Math.max(1,t*s.sharpness[o])}),e}var Cn=.1;function Dn(s){let t=s.amplitude.reduce((e,i)=>e+i**2/2,0);return Math.min(1,4*Math.sqrt(t)/Cn)}var Yt=class{constructor(t,{columns:e=384,rings:i=512}={}){this.gl=t,t.getExtension("EXT_color_buffer_float")??t.getExtension("EXT_color_buffer_half_float"),this.columns=e,this.ringCount=i,this.drawn=T(t,Ce,ze),this.readBack=null,this.sky=null,this.rings=b(t,{format:"RG32F",width:i,height:1,wrap:"clamp"}),this.noise=b(t,{format:"RG16F",width:st,height:st,filter:"linear",mips:!0,anisotropy:8}),Ds().forEach((o,n)=>this.noise.upload(o,n)),this.vertexArray=t.createVertexArray(),this.indices=t.createBuffer(),t.bindVertexArray(this.vertexArray),t.bindBuffer(t.ELEMENT_ARRAY_BUFFER,this.indices),t.bufferData(t.ELEMENT_ARRAY_BUFFER,Bn(e,i),t.STATIC_DRAW),t.bindVertexArray(null)}render(t,e,i,o,n,r,a,c=null){let{gl:l}=this,h=c??(this.sky??=new B(l,vi)),u={...Xt,...xi,...o},m={sun:nt(u.sunElevation,u.sunAzimuth),haze:u.haze,clouds:u.clouds};for(let w of[l.BLEND,l.CULL_FACE,l.DEPTH_TEST,l.SCISSOR_TEST])l.disable(w);h.update(m),l.bindFramebuffer(l.FRAMEBUFFER,null),l.viewport(0,0,n,r),l.enable(l.SCISSOR_TEST),l.scissor(...a),l.clearDepth(1),l.depthMask(!0),l.clear(l.DEPTH_BUFFER_BIT),l.enable(l.DEPTH_TEST),l.depthFunc(l.LESS);let p=n/r;l.bindVertexArray(this.vertexArray),this.drawn.use(this.values(t,e,i,u,p,h));let g=6*(this.columns-1)*(this.ringCount-1);l.drawElements(l.TRIANGLES,g,l.UNSIGNED_INT,0),l.bindVertexArray(null),l.depthFunc(l.LEQUAL);let v={exposureFactor:tt(u.exposure),linearLight:!1};h.drawBackground({...m,plain:null,...v},i.matrices(p)),l.disable(l.DEPTH_TEST),l.disable(l.SCISSOR_TEST)}readVertices(t,e,i,o,n,{fade:r=!0}={}){let{gl:a}=this;this.readBack??=T(a,Ce,ze,gi);let c=this.columns*this.ringCount,l=8,h=a.createBuffer(),u=a.createTransformFeedback();a.bindTransformFeedback(a.TRANSFORM_FEEDBACK,u),a.bindBufferBase(a.TRANSFORM_FEEDBACK_BUFFER,0,h),a.bufferData(a.TRANSFORM_FEEDBACK_BUFFER,4*l*c,a.STREAM_READ);let f=this.sky??=new B(a,vi),m={...Xt,...xi,...o},p=this.values(t,e,i,m,n,f);this.readBack.use(r?p:{...p,fade:0}),a.bindFramebuffer(a.FRAMEBUFFER,null),a.enable(a.RASTERIZER_DISCARD),a.beginTransformFeedback(a.POINTS),a.drawArrays(a.POINTS,0,c),a.endTransformFeedback(),a.disable(a.RASTERIZER_DISCARD);let g=new Float32Array(l*c);return a.getBufferSubData(a.TRANSFORM_FEEDBACK_BUFFER,0,g),a.bindTransformFeedback(a.TRANSFORM_FEEDBACK,null),a.bindBufferBase(a.TRANSFORM_FEEDBACK_BUFFER,0,null),a.deleteTransformFeedback(u),a.deleteBuffer(h),Un(g,{still:2,moved:3,normal:3})}values(t,e,i,o,n,r){let{wavenumber:a,wave:c,count:l}=Pn(t,e,i.east,i.north),h=wt(i,n,zn(t,o.choppiness));this.rings.upload(yt(h.near,h.far,i.height,this.ringCount));let u=o.noiseFrequency/Cs;return{view_projection:i.matrices(n).viewProjection,rings:this.rings,columns:this.columns,waves:l,middle:h.middle,half_angle:h.half,apex:h.apex,height:i.height,fade:1,choppiness:o.choppiness,wavenumber:a,wave:c,noise:this.noise,noise_amplitude:Dn(t)*o.noiseAmplitude,noise_frequency:u,noise_start:[ht(i.east*u),ht(i.north*u)],ambient:o.ambient,diffuse:o.diffuse,specular:o.specular,shininess:o.shininess,albedo:Ct(zt(o.chlorophyll)).map(f=>$n*Math.PI*f),sunward:nt(o.sunElevation,o.sunAzimuth),sky:r.map,light:r.light,air_extinction:On*o.haze,exposure_factor:tt(o.exposure),linear_light:!1}}dispose(){let{gl:t}=this;for(let e of[this.drawn,this.readBack,this.rings,this.noise,this.sky])e?.dispose();t.deleteVertexArray(this.vertexArray),t.deleteBuffer(this.indices)}};function Bn(s,t){let e=new Uint32Array(6*(s-1)*(t-1)),i=0;for(let o=0;o<t-1;o++)for(let n=0;n<s-1;n++){let r=o*s+n;e.set([r,r+1,r+s],i),e.set([r+s,r+1,r+s+1],i+3),i+=6}return e}function Un(s,t){let e=Object.values(t).reduce((r,a)=>r+a,0),i=s.length/e,o={},n=0;for(let[r,a]of Object.entries(t)){let c=new Float32Array(a*i);for(let l=0;l<c.length;l++)c[l]=s[Math.floor(l/a)*e+n+l%a];o[r]=c,n+=a}return o}var Kt=class{constructor(t){this.gl=t,this.extension=t.getExtension("EXT_disjoint_timer_query_webgl2"),this.pending=new Map,this.means=new Map,this.open=!1,this.waits=!1,this.waited=new Map}milliseconds(t){return this.means.get(t)??null}measure(t,e){let{extension:i,gl:o}=this;if(this.collect(t),!i&&this.waits&&!this.open){this.wait(t,e);return}if(!i||this.open||this.pending.has(t)){e();return}let n=o.createQuery();o.beginQuery(i.TIME_ELAPSED_EXT,n),this.open=!0;try{e()}finally{o.endQuery(i.TIME_ELAPSED_EXT),this.open=!1,this.pending.set(t,n)}}collect(t){let{extension:e,gl:i}=this,o=this.pending.get(t);if(!o||!i.getQueryParameter(o,i.QUERY_RESULT_AVAILABLE))return;!i.getParameter(e.GPU_DISJOINT_EXT)&&this.note(t,i.getQueryParameter(o,i.QUERY_RESULT)/1e6),i.deleteQuery(o),this.pending.delete(t)}note(t,e){let i=this.means.get(t)??e;this.means.set(t,i+.15*(e-i))}wait(t,e){let i=performance.now();if(i-(this.waited.get(t)??-1/0)<1e3){e();return}this.waited.set(t,i),this.finish();let o=performance.now();e(),this.finish(),this.note(t,performance.now()-o)}finish(){let{gl:t}=this,e=new Uint8Array(4);t.bindFramebuffer(t.FRAMEBUFFER,null),t.readPixels(0,0,1,1,t.RGBA,t.UNSIGNED_BYTE,e)}};function V(s,t,e,i){let o={format:"RGBA16F",width:t,height:e,filter:"linear",mips:!0};return{displacement:b(s,o),slopes:b(s,{...o,anisotropy:i}),moments:b(s,{...o,anisotropy:i})}}function ut(s){for(let t of Object.values(s))t.dispose()}var yi=`${E}
uniform sampler2D displacement_before,displacement_after,slopes_before,slopes_after;
uniform float share;
layout(location=0) out vec4 displacement;
layout(location=1) out vec4 slopes;
layout(location=2) out vec4 moments;
vec4 between(sampler2D before,sampler2D after){
ivec2 at=ivec2(gl_FragCoord.xy);
return mix(texelFetch(before,at,0),texelFetch(after,at,0),share);
}
void main(){
displacement=between(displacement_before,displacement_after);
slopes=between(slopes_before,slopes_after);
moments=vec4(slopes.xy*slopes.xy,slopes.x*slopes.y,0.0);
}`;var qn=128*2**20,Gn=8,Hn=2e3,jn=4,Qt=["displacement","slopes","moments"],bi=16,Vn=Promise.resolve();function Wn(s){let{header:t,rest:e}=_t(s,"FFTB"),{tile:i,frame:o,nx:n,ny:r}=t,a=4*n*r,c=Math.ceil(2*a/bi)*bi;if(e.length<Qt.length*c)throw new Error(`a frame of ${n} x ${r} must have ${Qt.length*c} bytes, got ${e.length}`);let l=Qt.map((h,u)=>{let f=e.subarray(u*c,u*c+2*a),m=f.byteOffset%2?f.slice():f;return new Uint16Array(m.buffer,m.byteOffset,a)});return{tile:i,frame:o,nx:n,ny:r,maps:l}}var Jt=class{constructor(t,e,i,o={}){t.getExtension("EXT_color_buffer_float")??t.getExtension("EXT_color_buffer_half_float"),this.gl=t,this.kind="playback",this.note="",this.document=e,this.requestFrame=i,this.blend=o.blend??!1,this.onChange=o.onChange??(()=>{}),this.now=o.now??(()=>performance.now()),this.tiles=e.tiles.map(({n:[a,c],size:[l,h]})=>({nx:a,ny:c,lx:l,ly:h,maps:V(t,a,c,8)}));let n=this.tiles.reduce((a,{nx:c,ny:l})=>a+24*c*l,0),r=Math.floor((o.memory??qn)/n);this.ahead=Math.min(Math.max(r,2),e.frames),this.frames=new Map,this.requests=new Map,this.position=0,this.shown="",this.blending=null,this.request()}get frame(){return Math.floor(this.position)}get shownFrame(){return this.shown===""?null:Number.parseInt(this.shown,10)}get fits(){return this.ahead===this.document.frames}get whole(){return this.fits&&Array.from({length:this.ahead},(t,e)=>e).every(t=>this.has(t))}get weight(){return 1}step(t){let{frames:e,ticks:i}=this.document;return this.position=t%i*e/i,this.request(),this.gl.isContextLost()||this.show(),Vn}receive(t){let{tile:e,frame:i,nx:o,ny:n,maps:r}=Wn(t),a=this.tiles[e];if(!a||o!==a.nx||n!==a.ny)throw new Error(`a frame of tile ${e} must have its samples, got ${o} x ${n}`);this.requests.delete(_i(e,i)),this.isAhead(i)&&(this.frames.has(i)||this.frames.set(i,[]),this.frames.get(i)[e]=r,this.request(),this.has(i)&&this.onChange())}request(){let{frames:t}=this.document;for(let o of this.frames.keys())this.isAhead(o)||this.frames.delete(o);for(let[o,{frame:n}]of this.requests)this.isAhead(n)||this.requests.delete(o);let e=this.now(),i=0;for(let{until:o}of this.requests.values())e<o&&(i+=1);for(let o=0;o<this.ahead;o++){let n=(this.frame+o)%t;for(let r=0;r<this.tiles.length;r++){if(i>=Gn)return;if(this.frames.get(n)?.[r])continue;let a=_i(r,n),c=this.requests.get(a);if(c&&(e<c.until||c.times>jn))continue;let l=(c?.times??0)+1;this.requests.set(a,{frame:n,times:l,until:e+Hn*2**(l-1)}),i+=1,this.ask(r,n)}}}ask(t,e){this.requestFrame(t,e)?.then?.(o=>this.gl&&this.receive(o),o=>this.note=String(o.message??o))}isAhead(t){let{frames:e}=this.document;return(t-this.frame+e)%e<this.ahead}has(t){let e=this.frames.get(t);return!!e&&this.tiles.every((i,o)=>e[o])}show(){let{frame:t,document:e}=this;if(!this.has(t))return;let i=(t+1)%e.frames,o=this.blend&&this.has(i)?this.position-t:0,n=`${t} ${o}`;n!==this.shown&&(o>0?this.showBlended(t,i,o):this.upload(t),this.shown=n)}upload(t){this.tiles.forEach(({maps:e},i)=>{Qt.forEach((o,n)=>{e[o].upload(this.frames.get(t)[i][n]),e[o].generateMips()})})}showBlended(t,e,i){let{gl:o}=this;this.blending??=this.makeBlending();for(let n of[o.BLEND,o.DEPTH_TEST,o.CULL_FACE,o.SCISSOR_TEST])o.disable(n);this.tiles.forEach(({maps:n},r)=>{let{ends:a,into:c}=this.blending.tiles[r];[t,e].forEach((h,u)=>{if(a[u].frame===h)return;let[f,m]=this.frames.get(h)[r];a[u].displacement.upload(f),a[u].slopes.upload(m),a[u].frame=h});let l={share:i,displacement_before:a[0].displacement,displacement_after:a[1].displacement,slopes_before:a[0].slopes,slopes_after:a[1].slopes};A(o,this.blending.program,l,c);for(let h of Object.values(n))h.generateMips()}),o.bindFramebuffer(o.FRAMEBUFFER,null)}makeBlending(){let{gl:t}=this,e=this.tiles.map(({nx:i,ny:o,maps:n})=>{let r=()=>b(t,{format:"RGBA16F",width:i,height:o}),a=()=>({displacement:r(),slopes:r(),frame:-1});return{ends:[a(),a()],into:M(t,Object.values(n))}});return{program:T(t,yi),tiles:e}}dispose(){for(let{maps:t}of this.tiles)ut(t);if(this.blending){this.blending.program.dispose();for(let{ends:t,into:e}of this.blending.tiles){e.dispose({keepTextures:!0});for(let{displacement:i,slopes:o}of t)i.dispose(),o.dispose()}}this.frames.clear(),this.requests.clear(),this.tiles=[],this.gl=null}};function _i(s,t){return`${s} ${t}`}var W=class{constructor(t){this.revision=0,this.lastTick=0,this.show(t)}show(t){this.sea=t,this.from=t.tiles,this.to=t.tiles,this.scaleFrom=0,this.scaleTo=1,this.duration=0,this.numbers=null,this.next=null,this.pending=null,this.revision++}get document(){return this.numbers?{...this.sea.document,...this.numbers.now}:this.sea.document}get newest(){return this.next??this.sea}get weight(){return this.scaleTo}replace(t,e){if(!(e>0)){this.show(t);return}let i=this.pending??{sea:this.sea,tiles:this.shown(),tick:this.lastTick};this.from=i.tiles,this.revision++;let o={from:this.document,to:t.document,total:e,passed:0};Kn(i.sea,t)?(this.pending=i,this.sea=t,this.to=t.tiles,this.next=null,this.begin(1,0,0,1,e)):(this.pending=null,this.sea=i.sea,this.to=i.tiles,this.next=t,this.begin(1,0,0,0,e/2)),this.numbers=o,this.average()}average(){let{from:t,to:e,passed:i,total:o}=this.numbers;this.numbers.now={};for(let n of Xn)n in t&&n in e&&(this.numbers.now[n]=Ei(t[n],e[n],Math.min(1,i/o)))}begin(t,e,i,o,n){Object.assign(this,{scaleFrom:t,scaleTo:e,lastFrom:i,lastTo:o,duration:n}),this.ends={scaleFrom:t,scaleTo:e},this.elapsed=0}shown(){let{from:t,to:e,scaleFrom:i,scaleTo:o}=this;return i===0&&o===1?e:e.map((n,r)=>Qn(t[r],n,i,o))}advance(t){if(this.duration===0||!(t>0))return;this.elapsed+=t,this.numbers.passed+=t,this.average();let e=Math.min(1,this.elapsed/this.duration),{scaleFrom:i,scaleTo:o}=this.ends;if(this.scaleFrom=i+e*(this.lastFrom-i),this.scaleTo=o+e*(this.lastTo-o),!(e<1))if(this.next){let{duration:n,next:r,numbers:a}=this;this.show(r),this.numbers=a,this.begin(0,0,0,1,n)}else this.numbers=null,this.scaleFrom=0,this.scaleTo=1,this.duration=0}prepare(t){if(this.pending){let{sea:e,tiles:i,tick:o}=this.pending,{document:n}=e,r=Yn(n,this.document)?t:o;this.from=i.map((a,c)=>Zn(a,r,n.ticks,this.to[c],t,this.document.ticks)),this.to=this.to.map((a,c)=>Jn(a,i[c])),this.pending=null,this.revision++}this.lastTick=t}},Xn=["choppiness","slope_variance","foam"];function Ei(s,t,e){if(typeof s=="number"&&typeof t=="number")return s+e*(t-s);if(!s||!t||typeof s!="object")return t;let i=Object.keys(t).map(o=>[o,Ei(s[o],t[o],e)]);return Array.isArray(t)?i.map(([,o])=>o):Object.fromEntries(i)}function Yn(s,t){return s.loop===t.loop&&s.ticks===t.ticks}function Kn(s,t){return s.tiles.length===t.tiles.length&&s.tiles.every((e,i)=>["nx","ny","lx","ly"].every(o=>e[o]===t.tiles[i][o]))}function Qn(s,t,e,i){let o=new Float32Array(t.h0.length),[n,r]=[s.h0,t.h0];for(let c=0;c<o.length;c++)o[c]=e*n[c]+i*r[c];let a=t.wave.slice();if(e>0){let c=e/(e+i),{wave:l}=s;for(let h=1;h<a.length;h+=2)a[h]+=c*(l[h]-a[h])}return{...t,h0:o,wave:a}}function Jn(s,t){let[e,i]=[s.wave,t.wave],o=e;for(let n=0;n<e.length;n+=2)e[n]!==0||i[n]===0||(o===e&&(o=e.slice()),o[n]=i[n]);return o===e?s:{...s,wave:o}}function Zn(s,t,e,i,o,n){let[r,a]=[s.wave,i.wave],c=e===n&&t===o,{h0:l}=s;for(let h=0;h<r.length;h+=2){let u=r[h],f=a[h]||u;if(u===0||c&&u===f)continue;let m=u*t%e/e-f*o%n/n;l===s.h0&&(l=s.h0.slice());let p=Math.cos(2*Math.PI*m),g=Math.sin(2*Math.PI*m);for(let[v,w]of[[2*h,g],[2*h+2,-g]]){let x=l[v];l[v]=x*p+l[v+1]*w,l[v+1]=l[v+1]*p-x*w}}return{...s,h0:l}}var Ti=`${E}
uniform sampler2D input_first,input_second;
uniform float choppiness;
uniform vec4 lifts;
layout(location=0) out vec4 displacement;
layout(location=1) out vec4 slopes;
layout(location=2) out vec4 moments;
void main(){
ivec2 at=ivec2(gl_FragCoord.xy);
vec4 first=texelFetch(input_first,at,0),second=texelFetch(input_second,at,0);
first.yw/=lifts.xy;
second.yw/=lifts.zw;
displacement=vec4(choppiness*first.xy,first.z,choppiness*first.w);
slopes=vec4(second.xy,choppiness*second.zw);
moments=vec4(second.xy*second.xy,second.x*second.y,0.0);
}`;function Be(s,t="polynomial"){let e=t==="platform",i=e?"return phasor(float(index & (samples - 1)) / float(samples));":"return texelFetch(twiddles, ivec2(index & (samples - 1), 0), 0).xy;",o=Array.from({length:s-1},(n,r)=>`add(at + ${r+1} * apart, ${r+1});`);return`${E}${e?lt(t):""}
uniform sampler2D input_first,input_second${e?"":",twiddles"};
uniform int samples,block,axis;
layout(location=0) out vec4 first;
layout(location=1) out vec4 second;
int turn;
vec2 twiddle(int index){
${i}
}
vec4 multiply(vec2 w,vec4 v){
return vec4(w.x*v.xz - w.y*v.yw,w.x*v.yw + w.y*v.xz).xzyw;
}
void add(ivec2 at,int part){
vec2 w=twiddle(part*turn);
first +=multiply(w,texelFetch(input_first,at,0));
second +=multiply(w,texelFetch(input_second,at,0));
}
void main(){
ivec2 at=ivec2(gl_FragCoord.xy);
int i=axis==0?at.x:at.y;
int quotient=i/block,remainder=i & (block - 1);
int part=block/${s};
turn=remainder*(samples/block);
int from=quotient*part + (remainder & (part - 1));
int distance=samples/${s};
ivec2 apart=axis==0?ivec2(distance,0):ivec2(0,distance);
at=axis==0?ivec2(from,at.y):ivec2(at.x,from);
first=texelFetch(input_first,at,0);
second=texelFetch(input_second,at,0);
${o.join(`
 `)}
}`}function Si(s){let t=new Float64Array(2*s);for(let e=0;e<s;e++){let i=4*e/s,o=Number.isInteger(i);t[2*e]=o?[1,0,-1,0][i]:Math.cos(2*Math.PI*e/s),t[2*e+1]=o?[0,1,0,-1][i]:Math.sin(2*Math.PI*e/s)}return t}var Zt=class{constructor(t,e){this.gl=t,this.steps={2:T(t,Be(2,e)),4:T(t,Be(4,e))},this.twiddles=new Map,this.targets=new Map}targetsOf(t,e){let{gl:i}=this,o=`${t} x ${e}`;if(!this.targets.has(o)){let n=()=>b(i,{format:"RGBA32F",width:t,height:e});this.targets.set(o,[0,1].map(()=>M(i,[n(),n()])))}return this.targets.get(o)}twiddlesOf(t){if(!this.twiddles.has(t)){let e=Float32Array.from(Si(t));this.twiddles.set(t,b(this.gl,{format:"RG32F",width:t,height:1,data:e}))}return this.twiddles.get(t)}run(t,e){let[i,o]=this.targetsOf(t,e);for(let[n,r]of[t,e].entries()){let a=this.twiddlesOf(r),c=1;for(;c<r;){let l=c===1&&Math.log2(r)%2?2:4;c*=l;let[h,u]=i.textures,f={input_first:h,input_second:u,twiddles:a,samples:r,block:c,axis:n};A(this.gl,this.steps[l],f,o),[i,o]=[o,i]}}return i}dispose(){let t=[...Object.values(this.steps),...this.twiddles.values()];for(let e of[...t,...[...this.targets.values()].flat()])e.dispose()}};var Ue=128;function tr(){let s=URL.createObjectURL(new Blob([`(()=>{var O=["displace_x","displace_y","height","stretch_xy","slope_x","slope_y","stretch_xx","stretch_yy"];function U(c){let e=new Float64Array(2*c);for(let t=0;t<c;t++){let s=4*t/c,r=Number.isInteger(s);e[2*t]=r?[1,0,-1,0][s]:Math.cos(2*Math.PI*t/c),e[2*t+1]=r?[0,1,0,-1][s]:Math.sin(2*Math.PI*t/c)}return e}var $=class{constructor(e,t){this.nx=e,this.ny=t,this.tableX=U(e),this.tableY=e===t?this.tableX:U(t),this.scratch=[new Float64Array(e*t),new Float64Array(e*t)]}inverse(e,t){let{nx:s,ny:r,scratch:o}=this;this.along(e,t,r,s,this.tableY),_(e,o[0],r,s),_(t,o[1],r,s),e.set(o[0]),t.set(o[1]),this.along(e,t,s,r,this.tableX),_(e,o[0],s,r),_(t,o[1],s,r),e.set(o[0]),t.set(o[1])}along(e,t,s,r,o){let[n,i]=[e,t],[p,u]=this.scratch,m=s/2*r;for(let g=2;g<=s;g*=2){let b=g/2;for(let h=0;h<s/2;h++){let a=h&b-1,d=(2*(h-a)+a)*r,l=d+b*r,f=o[2*a*s/g],F=o[2*a*s/g+1],y=h*r;for(let w=0;w<r;w++){let E=n[y+m+w],A=i[y+m+w],M=f*E-F*A,x=f*A+F*E,I=n[y+w],T=i[y+w];p[d+w]=I+M,u[d+w]=T+x,p[l+w]=I-M,u[l+w]=T-x}}[n,i,p,u]=[p,u,n,i]}n!==e&&(e.set(n),t.set(i))}};function _(c,e,t,s){for(let o=0;o<t;o+=16)for(let n=0;n<s;n+=16){let i=Math.min(o+16,t),p=Math.min(n+16,s);for(let u=o;u<i;u++)for(let m=n;m<p;m++)e[m*t+u]=c[u*s+m]}}var q=new Float32Array(1),Y=new Uint32Array(q.buffer);function R(c){q[0]=c;let e=Y[0]>>>16&32768,t=Y[0]&2147483647;if(t>2139095040)return 32256;if(t>=1199566848)return e|31744;if(t<947912704){let s=Math.abs(c)*16777216,r=Math.floor(s),o=s-r;return e|r+(o>.5||o===.5&&r&1?1:0)}return e|t-939524096+4095+(t>>>13&1)>>>13}function L(c){let e=new Uint16Array(c.length);for(let t=0;t<c.length;t++)e[t]=R(c[t]);return e}var S=class{constructor(e,t=e){this.to=e,this.from=t;let s=e.nx*e.ny;this.fourier=new $(e.nx,e.ny),this.parts=Array.from({length:8},()=>new Float64Array(s))}fields(e,t,s=1,r=0){this.evolve(e,t,s,r);let{parts:o}=this;for(let n=0;n<8;n+=2)this.fourier.inverse(o[n],o[n+1]);return Object.fromEntries(O.map((n,i)=>[n,o[i]]))}evolve(e,t,s,r){let{to:o,from:n,parts:i}=this,{nx:p,ny:u,lx:m,ly:g}=o,b=[[s,o],[r,n]].filter(([h])=>h!==0);for(let h=0;h<u;h++){let a=2*Math.PI*(2*h<u?h:h-u)/g;for(let d=0;d<p;d++){let l=h*p+d,f=2*Math.PI*(2*d<p?d:d-p)/m,F=2*Math.PI*(o.wave[2*l]*e%t)/t,y=Math.cos(F),w=Math.sin(F),E=0,A=0,M=0,x=0;for(let[I,{h0:T,wave:k}]of b){let[j,P,B,G]=[T[4*l],T[4*l+1],T[4*l+2],T[4*l+3]],V=I*(j*y+P*w+B*y-G*w),D=I*(P*y-j*w+G*y+B*w);E+=V,A+=D,M+=V*k[2*l+1],x+=D*k[2*l+1]}i[0][l]=-f*x-a*M,i[1][l]=f*M-a*x,i[2][l]=E+f*a*x,i[3][l]=A-f*a*M,i[4][l]=-f*A-a*E,i[5][l]=f*E-a*A,i[6][l]=-f*f*M+a*a*x,i[7][l]=-f*f*x-a*a*M}}}};function C(c,e,t,s){let r={displacement:[],slopes:[],moments:[]},o=Object.fromEntries(Object.keys(r).map(a=>[a,new Float32Array(4*e*t)])),{displace_x:n,displace_y:i,height:p,stretch_xy:u,slope_x:m,slope_y:g,stretch_xx:b,stretch_yy:h}=c;for(let a=0;a<e*t;a++){let d=m[a],l=g[a],f=4*a;o.displacement[f]=s*n[a],o.displacement[f+1]=s*i[a],o.displacement[f+2]=p[a],o.displacement[f+3]=s*u[a],o.slopes[f]=d,o.slopes[f+1]=l,o.slopes[f+2]=s*b[a],o.slopes[f+3]=s*h[a],o.moments[f]=d*d,o.moments[f+1]=l*l,o.moments[f+2]=d*l}for(let a of Object.keys(r))r[a]=W(o[a],e,t);return r}function W(c,e,t){let s=[L(c)];for(;e>1||t>1;){let[r,o]=[e>1?2:1,t>1?2:1],[n,i]=[e/r,t/o],p=new Float32Array(4*n*i),u=4*(r-1),m=4*e*(o-1);for(let g=0;g<i;g++)for(let b=0;b<n;b++)for(let h=0;h<4;h++){let a=4*(g*o*e+b*r)+h;p[4*(g*n+b)+h]=(c[a]+c[a+u]+c[a+m]+c[a+u+m])/4}s.push(L(p)),[c,e,t]=[p,n,i]}return s}var N=[],v=1,X={load({sets:c,ticks:e}){return v=e,N=c.map(({to:t,from:s},r)=>{let o=N[r];return o?.to.nx!==t.nx||o.to.ny!==t.ny?new S(t,s):Object.assign(o,{to:t,from:s})}),[{},[]]},step({tick:c,choppiness:e,scaleTo:t,scaleFrom:s}){let r=N.map(n=>{let i=n.fields(c,v,t,s);return C(i,n.to.nx,n.to.ny,e)}),o=r.flatMap(n=>Object.values(n).flat());return[{maps:r},o.map(n=>n.buffer)]},read({index:c,tick:e,scaleTo:t,scaleFrom:s}){let r=N[c].fields(e,v,t,s),o={};for(let n of O)o[n]=Float32Array.from(r[n]);return[{fields:o},Object.values(o).map(n=>n.buffer)]}};globalThis.onmessage=({data:{kind:c,number:e,...t}})=>{try{let[s,r]=X[c](t);globalThis.postMessage({number:e,...s},r)}catch(s){globalThis.postMessage({number:e,failed:String(s?.message??s)})}};})();
`],{type:"text/javascript"})),t=new Worker(s);return URL.revokeObjectURL(s),t}var te=class s{static async start(t,e,i){let o=new s(t,e,i);try{await o.step(0)}catch(n){throw o.dispose(),n}return o}constructor(t,e,{prefer:i,anisotropy:o=8,makeWorker:n=tr}={}){this.gl=t,this.kind="worker",this.reason=i==="worker"?"As asked for":"This graphics card cannot draw into 32-bit floats (EXT_color_buffer_float)",this.anisotropy=o,this.blend=new W(this.fitted(e)),this.shown={tick:0,choppiness:e.document.choppiness??1},this.tiles=[],this.wanted=null,this.running=null,this.requests=new Map,this.worker=n(),this.worker.onmessage=({data:r})=>this.receive(r),this.worker.onerror=r=>{r.preventDefault?.(),this.fail(`the Worker that computes the sea failed: ${r.message||"it did not load"}`)}}get document(){return this.blend.document}get sea(){return this.blend.newest}get weight(){return this.blend.weight}get tick(){return this.shown.tick}get choppiness(){return this.shown.choppiness}fitted(t){let{sea:e,lost:i}=er(t,Ue),o=i?`; the ${i} shortest waves are left out`:"";return this.note=`${this.reason}: JavaScript computes the sea, with at most ${Ue} x ${Ue} samples a tile${o}.`,this.reduced=i>0,e}step(t,e=this.choppiness){return this.wanted={tick:t>>>0,choppiness:e},this.running||(this.running=this.run(),this.running.catch(()=>{})),this.running}async run(){try{for(;this.wanted&&!this.gl.isContextLost();){let{tick:t,choppiness:e}=this.wanted;this.wanted=null;let{blend:i}=this;i.prepare(t);let{scaleTo:o,scaleFrom:n,to:r,from:a,document:c}=i;if(this.revision!==i.revision){let u=r.map((f,m)=>({to:f,from:a[m]}));this.revision=i.revision,this.request("load",{sets:u,ticks:c.ticks})}let l={tick:t,choppiness:e,scaleTo:o,scaleFrom:n},{maps:h}=await this.request("step",l);this.show(r,h),this.shown=l}}finally{this.running=null}}async readFields(t){await this.running;let{tick:e,scaleTo:i,scaleFrom:o}=this.shown;return(await this.request("read",{index:t,tick:e,scaleTo:i,scaleFrom:o})).fields}replace(t,e=.3){this.blend.replace(this.fitted(t),e)}advance(t){this.blend.advance(t)}show(t,e){let i=({nx:o,ny:n},r)=>o===t[r].nx&&n===t[r].ny;if(this.tiles.length!==t.length||!this.tiles.every(i)){for(let o of this.tiles)ut(o.maps);this.tiles=t.map(({nx:o,ny:n})=>({nx:o,ny:n,maps:V(this.gl,o,n,this.anisotropy)}))}this.tiles.forEach((o,n)=>{let{lx:r,ly:a}=t[n];Object.assign(o,{lx:r,ly:a});for(let[c,l]of Object.entries(e[n]))l.forEach((h,u)=>o.maps[c].upload(h,u))})}request(t,e){if(this.failure)return Promise.reject(new Error(this.failure));let i=this.count=(this.count??0)+1;return new Promise((o,n)=>{this.requests.set(i,{resolve:o,reject:n}),this.worker.postMessage({kind:t,number:i,...e})})}receive({number:t,failed:e,...i}){let{resolve:o,reject:n}=this.requests.get(t);this.requests.delete(t),e?n(new Error(`the Worker that computes the sea failed: ${e}`)):o(i)}fail(t){this.failure=t,this.note=t;for(let{reject:e}of this.requests.values())e(new Error(t));this.requests.clear()}dispose(){this.worker.terminate(),this.fail("the simulation has ended");for(let t of this.tiles)ut(t.maps);this.tiles=[]}};function er(s,t){let e=0,i=[0,0,0],o=s.tiles.map(a=>{let{nx:c,ny:l,lx:h,ly:u,h0:f,wave:m}=a;if(c<=t&&l<=t)return a;let[p,g]=[Math.min(c,t),Math.min(l,t)],v={...a,nx:p,ny:g,h0:new Float32Array(4*p*g),wave:new Float32Array(2*p*g)};for(let w=0;w<l;w++){let x=2*w<l?w:w-l;for(let y=0;y<c;y++){let _=2*y<c?y:y-c,S=w*c+y;if(2*Math.abs(_)<p&&2*Math.abs(x)<g){let R=(x&g-1)*p+(_&p-1);v.h0.set(f.subarray(4*S,4*S+4),4*R),v.wave.set(m.subarray(2*S,2*S+2),2*R)}else if(f[4*S]||f[4*S+1]){let R=2*(f[4*S]**2+f[4*S+1]**2),[F,z]=[2*Math.PI*_/h,2*Math.PI*x/u];[F*F,z*z,F*z].forEach((dt,X)=>i[X]+=R*dt),e++}}}return v}),{slope_variance:n}=s.document;if(!e||!n)return{sea:{...s,tiles:o},lost:e};let r={...n,captured:n.captured.map((a,c)=>a-i[c]),beyond:n.beyond.map((a,c)=>a+i[c])};return{sea:{...s,tiles:o,document:{...s.document,slope_variance:r}},lost:e}}async function ki(s,t,e={}){for(let{nx:i,ny:o}of t.tiles)q("n",i),q("n",o);return e.prefer!=="worker"&&sr(s)?new Ge(s,t,e):te.start(s,t,e)}function sr(s){if(!s.getExtension("EXT_color_buffer_float"))return!1;let t=()=>b(s,{format:"RGBA32F",width:4,height:4}),e=M(s,[t(),t()]),{complete:i}=e;return e.dispose(),i}var Ge=class{constructor(t,e,{sine:i="polynomial",anisotropy:o=8}={}){this.gl=t,this.kind="gpu",this.note="",this.anisotropy=o,this.blend=new W(e),this.evolve=T(t,mi(i)),this.transforms=new Zt(t,i),this.shade=T(t,Ti),this.revision=-1,this.tick=0,this.choppiness=e.document.choppiness??1,this.tiles=[],this.upload()}get document(){return this.blend.document}get sea(){return this.blend.newest}get weight(){return this.blend.weight}step(t,e=this.choppiness){let{gl:i}=this;if(i.isContextLost())return Mi;this.tick=t>>>0,this.choppiness=e,this.blend.prepare(this.tick),this.revision!==this.blend.revision&&this.upload();for(let o of[i.BLEND,i.DEPTH_TEST,i.CULL_FACE,i.SCISSOR_TEST])i.disable(o);for(let o of this.tiles){let n=this.fieldsOf(o),[r,a]=n.textures,{lifts:c}=o,l={input_first:r,input_second:a,choppiness:e,lifts:c};A(i,this.shade,l,o.target);for(let h of o.target.textures)h.generateMips()}return i.bindFramebuffer(i.FRAMEBUFFER,null),Mi}async readFields(t){let e=this.tiles[t],i=this.fieldsOf(e),o=[i.read(0),i.read(1)];this.gl.bindFramebuffer(this.gl.FRAMEBUFFER,null);let n={};return L.forEach((r,a)=>{let c=new Float32Array(e.nx*e.ny),l=o[a>>2],h=a&1?1/e.lifts[a>>1]:1;for(let u=0;u<c.length;u++)c[u]=h*l[4*u+(a&3)];n[r]=c}),n}replace(t,e=.3){this.blend.replace(t,e)}advance(t){this.blend.advance(t)}fieldsOf(t){let{blend:e}=this,{nx:i,ny:o,lx:n,ly:r,lifts:a}=t,c={...t.tables,samples:[i,o],wavenumber_step:[2*Math.PI/n,2*Math.PI/r],tick:this.tick,mask:this.document.ticks-1,turns_per_tick:1/this.document.ticks,lifts:a,scale_to:e.scaleTo,scale_from:e.scaleFrom};return A(this.gl,this.evolve,c,this.transforms.targetsOf(i,o)[0]),this.transforms.run(i,o)}upload(){let{blend:t,gl:e}=this,i=(o,n)=>["nx","ny"].every(r=>o[r]===t.to[n][r]);if(this.tiles.length!==t.to.length||!this.tiles.every(i)){for(let o of this.tiles)Ai(o);this.tiles=t.to.map(({nx:o,ny:n})=>ir(e,o,n,this.anisotropy))}this.tiles.forEach((o,n)=>{let{lx:r,ly:a,lifts:c,h0:l,wave:h}=t.to[n];Object.assign(o,{lx:r,ly:a,lifts:c}),o.tables.h0_to.upload(l),o.tables.wave_to.upload(h),o.tables.h0_from.upload(t.from[n].h0),o.tables.wave_from.upload(t.from[n].wave)}),this.revision=t.revision}dispose(){for(let t of this.tiles)Ai(t);this.tiles=[];for(let t of[this.evolve,this.transforms,this.shade])t.dispose()}},Mi=Promise.resolve();function ir(s,t,e,i){let o={width:t,height:e},n=l=>b(s,{format:l,...o}),r={h0_to:n("RGBA32F"),h0_from:n("RGBA32F"),wave_to:n("RG32F"),wave_from:n("RG32F")},a=V(s,t,e,i),c=M(s,Object.values(a));return{nx:t,ny:e,tables:r,maps:a,target:c}}function Ai(s){s.target.dispose();for(let t of Object.values(s.tables))t.dispose()}var or=1,nr=6,Ri={hardware:.5,software:1.5},rr={alpha:!1,antialias:!0,depth:!0,stencil:!1,powerPreference:"high-performance"},ft=[{quality:"high",scale:1},{quality:"medium",scale:1},{quality:"medium",scale:.75},{quality:"low",scale:.75},{quality:"low",scale:.5}],ar=3;function cr(s){let t=s.getExtension("WEBGL_debug_renderer_info"),e=t?s.getParameter(t.UNMASKED_RENDERER_WEBGL):"";return/swiftshader|llvmpipe|software/i.test(e)}function He(s){return s?"":"This browser has no WebGL 2, which the picture of the sea needs. A newer browser, or hardware acceleration switched on in its settings, shows it; the figures and the controls work."}function je(s){return`The picture cannot be drawn: ${s.message}`}var ee=class{constructor(t,{onChange:e,onTrouble:i,onNote:o,onCanvas:n,prefer:r="gpu"}){this.onChange=e,this.onTrouble=i,this.onNote=o,this.onCanvas=n,this.prefer=r,this.sea=null,this.bake=null,this.source=null,this.simulation=null,this.playback=null,this.renderer=null,this.few=null,this.timer=null,this.level=0,this.building=null,this.disposed=!1,this.losses=0,this.listen(t)}listen(t){this.canvas=t,this.listening?.abort(),this.listening=new AbortController;let{signal:e}=this.listening;t.addEventListener("webglcontextlost",i=>this.lost(i),{signal:e}),t.addEventListener("webglcontextrestored",()=>this.restored(),{signal:e}),this.gl=t.getContext("webgl2",rr),this.software=!!this.gl&&cr(this.gl),this.software&&(this.level=Math.max(this.level,ar))}get scale(){return ft[this.level].scale}coarser(){if(this.level===ft.length-1)return!1;let t=ft[this.level].quality;this.level+=1;let{quality:e}=ft[this.level];return e!==t&&this.renderer&&(this.renderer.dispose(),this.renderer=new ct(this.gl,{quality:e}),this.foamIsNew=!0),!0}get ready(){return!!(this.source&&this.renderer&&!this.gl.isContextLost())}get kind(){return this.playback?"playback":this.simulation?.kind??""}async setSea(t,e){if(this.sea=t,this.bake=null,!!this.gl){if(this.simulation&&!this.gl.isContextLost()){this.simulation.replace(t,e),this.onChange();return}await this.build()}}async setBake(t,e){this.bake={manifest:t,requestFrame:e},this.sea=null,this.gl&&await this.build()}async build(){for(;this.building;)await this.building;if(!(this.disposed||this.gl.isContextLost())){this.building=this.make();try{await this.building}finally{this.building=null}}}async make(){this.free();let{gl:t}=this;if(this.bake){let{manifest:e,requestFrame:i}=this.bake;this.playback=new Jt(t,e,i,{onChange:this.onChange}),this.source=this.playback}else{let e=this.sea,i=await ki(t,e,{prefer:this.prefer});if(this.disposed||t.isContextLost()){i.dispose();return}this.simulation=i,this.source=i,this.onNote(i.note??""),this.sea!==e&&i.replace(this.sea,0)}this.renderer=new ct(t,{quality:ft[this.level].quality}),this.timer=new Kt(t),this.foamIsNew=!0,this.onTrouble(""),this.onChange()}async step(t,e){let i=null;this.playback&&(this.playback.blend=this.blendFrames),this.timer.measure("waves",()=>{i=(this.simulation??this.playback)?.step(t,e)}),await i}advanceFoam(t,e,i=1){let{document:o,tiles:n}=this.source,{foam:r}=o,a=r&&{...r,strength:i*r.strength};this.renderer.advanceFoam({tiles:n,document:{...o,foam:a}},t,e)}async growFoam(t,e,i,o){let{playback:n}=this;if(this.foamIsNew=!!(n?.fits&&!n.whole),n&&!n.whole)return;this.renderer.restartFoam();let{loop:r,ticks:a}=t,c=this.software?Ri.software:Ri.hardware;for(let l=nr;l>=c;l-=c){let h=Math.floor(t.tick-l/r*a);if(await this.step((h%a+a)%a,e),!this.ready)return;this.advanceFoam(i,c,o)}}render(t,e,i,o){this.timer.measure("sea",()=>{this.renderer.render(this.source,t,e,i,o)})}renderFew(t,e,i,o,n,r){this.few??=new Yt(this.gl,this.renderer.quality);let a=Math.floor(n/2),c=[a,0,n-a,r],{sky:l}=this.renderer;this.timer.waits=!0,this.timer.measure("few",()=>{this.few.render(t,e,i,o,n,r,c,l)})}lost(t){t.preventDefault(),this.losses+=1,this.forget(),this.onTrouble("The graphics context was lost; the picture comes back."),clearTimeout(this.waiting),this.waiting=setTimeout(()=>this.replaceCanvas(),1e3*or)}restored(){clearTimeout(this.waiting),this.rebuild()}rebuild(){!this.sea&&!this.bake?this.onTrouble(""):this.build().catch(t=>this.onTrouble(je(t)))}replaceCanvas(){if(this.disposed||!this.gl?.isContextLost())return;let t=this.canvas.cloneNode(!1),e=document.activeElement===this.canvas;this.canvas.replaceWith(t),this.listen(t),this.onCanvas(t),e&&t.focus(),this.gl?this.rebuild():this.onTrouble(He(null))}forget(){this.simulation?.kind==="worker"&&this.simulation.dispose(),this.empty()}free(){for(let t of[this.simulation,this.playback,this.renderer,this.few])t?.dispose?.();this.empty()}empty(){Object.assign(this,{simulation:null,playback:null,source:null,renderer:null,few:null,timer:null})}dispose(){this.disposed=!0,clearTimeout(this.waiting),this.listening.abort(),this.gl&&(this.free(),this.gl.getExtension("WEBGL_lose_context")?.loseContext())}};var Ve={gpu:5e-7,worker:2e-7};function We(s,t){let e=0,i=0;for(let o=0;o<t.length;o++)e+=(s[o]-t[o])**2,i+=t[o]**2;return s.length!==t.length||Number.isNaN(e)?1/0:i>0?Math.sqrt(e/i):Math.sqrt(e)}function se(s){return s.weight!==1?"the sea is changing into another":s.reduced?"waves too short for this device are left out":s.document.quality==="moving"?"the amplitudes are approximate":""}async function Fi(s,{header:t,fields:e}){let{tile:i,tick:o}=t,n=s.tiles.length;if(!(i>=0&&i<n))throw new Error(`tile must be below ${n}, got ${i}`);let r=se(s);if(r)throw new Error(`nothing to verify: ${r}`);let a={sea:s.document.id,ticks:s.document.ticks,tick:s.tick,nx:s.tiles[i].nx,ny:s.tiles[i].ny};for(let[h,u]of Object.entries(a))if(t[h]!==void 0&&u!==void 0&&t[h]!==u)throw new Error(`a reference must have ${h} ${u}, got ${t[h]}`);let c=await s.readFields(i),l={};for(let h of L)l[h]=We(c[h],e[h]);return{tile:i,tick:o,...Xe(l,Ve[s.kind])}}function Xe(s,t){let e=Math.max(...Object.values(s));return{errors:s,worst:e,limit:t,passed:e<=t}}function Ii(s,t){return t?"a sea is being made":se(s)}async function Ni(s,t,e){return await s.step(t.header.tick,e),Fi(s,t)}var ie=class{constructor({reference:t}){this.reference=t}get possible(){return!!this.reference?.tiles?.length}get points(){let{moments:t,tiles:e}=this.reference;return t.length*e.reduce((i,{columns:o})=>i+o.length,0)}async run(t,e){let i=se(t);if(i)throw new Error(`nothing to verify: ${i}`);let{moments:o,tiles:n}=this.reference,r=n.map(()=>Object.fromEntries(L.map(a=>[a,[]])));for(let a of o){await t.step(a,e);for(let[c,{columns:l,rows:h}]of n.entries()){let u=await t.readFields(c),{nx:f}=t.tiles[c];for(let m of L)l.forEach((p,g)=>r[c][m].push(u[m][h[g]*f+p]))}}return n.map(({fields:a},c)=>{let l={};for(let h of L)l[h]=We(r[c][h],a[h].flat());return{tile:c,...Xe(l,Ve[t.kind])}})}};var Li=.3,lr=.25,Oi=60,hr=24,$i="The server has stopped or is out of reach, so that only light, camera and view can change. Start fftocean view again and open the address that it prints.",Pi=new Set(["choppiness"]),ur=/^few-wave/i,zi=new Set(["blend_frames"]),fr=["Local wind sea"],dr={height:"Height of the water",slopes:"Slopes",normals:"Normals",jacobian:"Jacobian: where the surface folds",foam:"Foam",roughness:"Roughness below the pixel",tiles:"Tiles",wireframe:"Mesh"};function pr(s){return s.replace(/_(.)/g,(t,e)=>e.toUpperCase())}async function Ci(s){let t=new Ye(s);return await t.start(),t}var Ye=class{constructor({root:t,table:e,keysOn:i=null,connect:o=null,embedded:n=null}){this.root=t,this.table=e,this.rows=new Map(e.parameters.map(r=>[r.name,r])),this.values=rs(e.parameters),this.served={},this.connect=o,this.embedded=n,this.connection=null,this.plan=Es(e.parameters,e.actions),this.held=new Ft(this.plan),this.keysEnabled=!0,this.camera=new xt({height:this.values.camera_height??12}),this.clock=new bt({loop:60,ticks:2**16}),this.clock.paused=Ze(),this.frameRate=new kt,this.rate=null,this.frames=0,this.dirty=!0,this.sea=null,this.bake=null,this.source="",this.busy=!1,this.mostTiles=1/0,this.servedSea=null,this.notes={sea:[],picture:[]},this.verifying=null,this.ending=new AbortController,this.canvas=d("canvas",{class:"sea",tabindex:"0",role:"img","aria-label":"The sea, live"}),this.layout=new Lt(t,{canvas:this.canvas,act:r=>this.act(r)}),this.announcer=new mt(this.layout.spoken),this.figures=new Rt({chip:this.layout.chip,body:this.layout.figures}),this.stage=new ee(this.canvas,{onChange:()=>this.changed(),onTrouble:r=>this.layout.showBanner(r),onNote:r=>this.showNotes({picture:r?[r]:[]}),onCanvas:r=>this.takeCanvas(r)}),this.buildControls(),this.buildHelp(),this.listen(i??t)}async start(){this.layout.showBanner(He(this.stage.gl)),this.layout.onToggle=(t,e)=>{t==="figures"&&e&&this.drawPlot()},this.layout.wide&&(this.layout.toggle("figures",!0),this.layout.toggle("controls",!0)),this.layout.showPaused(this.clock.paused),this.applyLocal(Object.keys(this.values)),this.controls.show(this.values,{force:!0}),this.connection=this.connect?.(this.listeners())??null,this.embedded&&await this.showEmbedded(),this.loop=t=>{this.handle=requestAnimationFrame(this.loop),this.frame(t).catch(e=>this.failed(e))},this.handle=requestAnimationFrame(this.loop)}buildControls(){let{layout:t}=this,e=(i,o)=>{let n=this.table.actions.find(r=>r.name===o)?.key;return t.addAction(i,n,()=>this.act(o))};this.copyButtons=[e("Copy job","copy_job"),e("Copy command","copy_command")],this.verifyButton=e("Verify","verify"),this.embedded||(this.openButton=e("Open file …","open")),this.fileInput=d("input",{type:"file",hidden:!0,tabindex:"-1","aria-label":"A job or a buoy file"}),this.fileInput.addEventListener("change",()=>{let[i]=this.fileInput.files;i&&he(i,this.fileReceivers()),this.fileInput.value=""}),this.presets=this.embedded?null:ms(this.table.presets,i=>this.change(i.values,{exactly:!0})),this.presets&&t.controls.append(this.presets.node),this.controls=new Mt(t.controls,this.table.parameters,{onChange:i=>this.change(i),open:this.embedded?["Light","Water"]:fr}),t.controls.append(this.fileInput,t.actions),this.embedded?this.keepOwnControls():this.controls.keepOnly(new Set([...this.rows.keys()].filter(i=>!zi.has(i))))}keepOwnControls(){if(this.controls.keepOnly(this.ownNames()),this.layout.fewButton.hidden=!0,this.presets&&(this.presets.node.hidden=!0),this.openButton&&(this.openButton.hidden=!0),this.bake&&(this.verifyButton.hidden=!0),this.bake)for(let t of this.copyButtons)t.hidden=!0}get fixed(){return!!(this.embedded||this.bake)}ownNames(){let t=this.bake?new Set:Pi,e=({name:o,group:n})=>!ur.test(n)&&(!!this.bake||!zi.has(o)),i=o=>o.local&&e(o)||t.has(o.name);return new Set(this.table.parameters.filter(i).map(o=>o.name))}buildHelp(){let t=[];for(let e of this.table.parameters){let i=[e.keyDown,e.keyUp].filter(Boolean);!i.length||this.embedded&&!e.local&&!Pi.has(e.name)||t.push([i,i.length===2?`${e.label} down, up`:`Next ${e.label.toLowerCase()}`])}for(let{key:e,label:i}of ge(this.table.actions))t.push([[e],i.slice(0,1).toUpperCase()+i.slice(1)]);this.layout.fillHelp(t,{enabled:this.keysEnabled,onEnabled:e=>{this.keysEnabled=e,this.held.clear()}})}listen(t){let{signal:e}=this.ending,i={signal:e};t.addEventListener("keydown",o=>this.keyDown(o),i),t.addEventListener("keyup",o=>this.keyUp(o),i),globalThis.addEventListener("blur",()=>this.held.clear(),i),this.root.addEventListener("focusin",o=>{It(o.target)&&this.held.clear()}),me(this.canvas,this.camera,{onMove:()=>this.moved(),signal:e}),this.resizes=new ResizeObserver(()=>this.resized());for(let o of[this.root,this.figures.plot])this.resizes.observe(o);this.embedded||gs(this.root,{...this.fileReceivers(),onOver:o=>this.layout.dropHint.hidden=!o,signal:e})}resized(){let{layout:t}=this,{wide:e}=t;if(this.wasWide&&!e)for(let i of["figures","controls"])t.close(i);this.wasWide=e,ve(this.figures.plot)||this.drawPlot(),this.changed()}fileReceivers(){return{onFile:(t,e)=>{let{message:i,refused:o}=le(t,e);o?this.refuse(o):this.sendOr(i)&&this.layout.toast(`Reading ${t}`)},onRefused:t=>this.refuse(t)}}listeners(){return{status:t=>this.showStatus(t),state:(t,e)=>this.takeState(t,e),sea:t=>this.takeSea(t),refused:t=>this.takeRefusal(t),reference:t=>this.takeReference(t),copied:({what:t,text:e})=>this.copy(t,e),bake:(t,e)=>this.takeBake(t,e),frame:t=>this.stage.playback?.receive(t)}}async showEmbedded(){let{bytes:t,about:e}=this.embedded,i=ne(t);this.source=e.source??"",this.served={choppiness:i.document.choppiness},this.values.choppiness=i.document.choppiness??this.values.choppiness,this.controls.show(this.values,{force:!0}),this.figures.showConnection("embedded","none: one file"),e.version&&this.figures.fact("Made by",`fftocean ${e.version}`),await this.showSea(i),await this.checkItself()}takeState(t,{source:e="",busy:i=!1,notes:o=[],sea:n=null,most_tiles:r}){this.served={...t},this.busy=i,this.source=e,this.mostTiles=r??1/0,this.servedSea=n;let a=this.connection?.pending??new Map;for(let[c,l]of Object.entries(t))a.has(c)||(this.values[c]=l);this.controls.show(this.values),i||this.showNotes({sea:o}),this.changed()}showNotes(t){let e=new Set(Object.values(this.notes).flat());Object.assign(this.notes,t);let i=Object.values(this.notes).flat();this.figures.showNotes(i);for(let o of i)e.has(o)||this.layout.toast(o)}async takeSea(t){try{await this.showSea(ne(t))}catch(e){this.refuse(`the sea cannot be shown: ${e.message}`)}}async showSea(t){let e=!this.sea;this.sea=t,this.bake=null,this.stage.simulation||this.clock.follow(t.document),this.showFigures(),await this.stage.setSea(t,e||this.clock.paused?0:Li),this.clock.paused&&t.document.quality!=="moving"&&(this.stage.foamIsNew=!0),this.changed()}async takeBake(t,{source:e=""}={}){if(this.bake=t,this.sea=null,this.source=e,this.clock.follow(t),this.keepOwnControls(),this.showFigures(),this.stage.playback)return;let i=(o,n)=>{this.connection.send({frame:{tile:o,frame:n}})};await this.stage.setBake(t,i),this.changed()}showFigures(){let t=this.sea?.document??this.bake;if(!t)return;let e=this.sentence(),i=this.bake?"recorded":t.quality??"exact";this.figures.showSea(t,{source:this.source,quality:i,sentence:e}),i!=="moving"&&this.announcer.say(e),this.drawPlot()}sentence(){return Je({document:this.sea?.document??this.bake,look:this.look(),paused:this.clock.paused,few:this.fewModel(),playback:!!this.bake})}drawPlot(){let{plot:t}=this.figures;if(t.hidden=!this.sea,!this.sea||this.layout.figures.hidden)return;let e=getComputedStyle(this.root),i=o=>e.getPropertyValue(o).trim();ks(t,this.sea,{line:i("--specified"),second:i("--realised"),area:i("--realised-area"),grid:i("--line"),text:i("--muted"),font:`${.72*Number.parseFloat(e.fontSize)}px ${e.fontFamily}`})}change(t){let e={},i=[],o=Object.keys(t);if(this.serverGone&&o.some(n=>this.rows.get(n)?.local===!1)){let n=Object.fromEntries(o.map(r=>[r,this.values[r]]));return this.controls.show(n,{force:!0}),this.refuse($i),!1}for(let[n,r]of Object.entries(t)){let a=this.rows.get(n);a&&(this.values[n]=r,this.controls.refuse(n,""),a.local?i.push(n):this.connection&&(e[n]=r))}return this.applyLocal(i),this.controls.show(t,{force:!0}),Object.keys(e).length&&this.connection.set(e),this.changed(),!0}applyLocal(t){for(let e of t){let i=this.values[e];e==="time_scale"&&(this.clock.scale=i),e==="blend_frames"&&(this.stage.blendFrames=i),e==="foam"&&this.clock.paused&&(this.stage.foamIsNew=!0),e==="camera_height"&&(this.camera.height=i),e==="field_of_view"&&(this.camera.fieldOfView=i),e==="view"&&this.layout.showView(dr[i]??""),e==="sun_elevation"&&this.announcer.say(this.sentence())}}look(){let t={choppiness:this.values.choppiness};for(let e of this.table.parameters)e.local&&(t[pr(e.name)]=this.values[e.name]);return t}fewModel(){return this.values.model!=="fft"&&this.sea?.document.few_waves||null}changed(){this.dirty=!0}moved(){let t=this.camera.height;this.rows.has("camera_height")&&Math.abs(t-this.values.camera_height)>1e-6&&(this.values.camera_height=t,this.controls.show({camera_height:t})),this.changed()}keyDown(t){if(t.key==="Escape"&&It(t.target)&&this.root.contains(t.target)){t.target.blur(),this.canvas.focus();return}if(!this.keysEnabled||this.layout.text.node.open)return;let e=Ts(t,this.plan);e&&(this.layout.help.node.open&&e.name!=="help"||(t.preventDefault(),this.held.fast=t.shiftKey,e.type==="hold"?this.held.press(e.name):e.type==="step"?this.step(e.name,e.direction):this.act(e.name)))}keyUp(t){this.held.release(t.key),t.key==="Shift"&&(this.held.fast=!1)}step(t,e){let i=this.rows.get(t);if(this.fixed&&!this.ownNames().has(t)){this.refuse(`${i.label.toLowerCase()} is fixed: the sea is made already`);return}let o=t==="tiles"?Math.min(i.high,this.mostTiles):i.high,n=Tt({...i,high:o},this.values[t],e);if(!this.change({[t]:n}))return;let r=i.kind==="choice"?At(n):Q(i,n);this.layout.toast(`${i.label}: ${r}`)}act(t){({pause:()=>this.pause(!this.clock.paused),view:()=>this.step("view",1),few_waves:()=>this.step("model",1),copy_job:()=>this.askCopy("job"),copy_command:()=>this.askCopy("command"),screenshot:()=>this.screenshot(),help:()=>this.layout.toggleHelp(),verify:()=>this.verify(),open:()=>this.fileInput.click()})[t]?.()}pause(t){this.clock.paused=t,this.clock.last=null,this.frameRate.clear(),this.layout.showPaused(t),this.announcer.say(t?"Time stands still.":"Time goes on."),this.changed()}sendOr(t){if(!this.connection)this.refuse("this page has no server");else{if(this.connection.send(t))return!0;this.connection.ready||this.refuse("the server does not answer; the change is not made")}return!1}askCopy(t){if(this.connection){this.sendOr({copy:t});return}let{about:e={}}=this.embedded??{},i=t==="job"?this.sea?.document.job??e.job:e.command;i?this.copy(t,i):this.refuse(`this page carries no ${t==="job"?"job":"bake command"}`)}async copy(t,e){let i=t==="job"?"The job":"The bake command";this.copied={what:t,text:e};try{await navigator.clipboard.writeText(e),this.layout.toast(`${i} is on the clipboard`)}catch{this.layout.showText(i,e)}}async still(){return this.alone(async()=>this.stage.ready?(await this.picture(0,0),new Promise(t=>this.canvas.toBlob(t,"image/png"))):null)}async screenshot(){let t=await this.still();if(!t)return;let e=URL.createObjectURL(t),i=`fftocean-${String(this.clock.tick)}.png`;d("a",{href:e,download:i}).click(),setTimeout(()=>URL.revokeObjectURL(e),1e4),this.layout.toast(`Saved ${i}`)}async verify(){if(this.verifying)return;if(!this.stage.simulation){this.refuse("there is no sea to verify: a bake is played, or no picture can be drawn");return}if(!this.connection){await this.checkItself(),this.figures.revealVerification();return}let t=Ii(this.stage.simulation,this.busy);if(t){this.refuse(`verify once the sea is exact: ${t}`);return}let{tick:e}=this.clock,i=Promise.withResolvers?.()??mr();this.verifying={tick:e,answers:[],done:i,tiles:this.stage.simulation.tiles.length},this.verifyButton.disabled=!0;let o=setTimeout(()=>this.endVerifying(`no answer within ${Oi} s`),1e3*Oi),{id:n}=this.sea.document;this.sendOr({verify:{tick:e,sea:n}})||this.endVerifying(""),await i.promise,clearTimeout(o)}async takeReference(t){let{verifying:e}=this;if(e){try{let i=ss(t),{simulation:o}=this.stage,n=await this.alone(()=>Ni(o,i,this.values.choppiness));e.answers.push(n),this.changed()}catch(i){this.endVerifying(i.message);return}e.answers.length<e.tiles||this.endVerifying("")}}endVerifying(t){let{verifying:e}=this;if(e){if(this.verifying=null,this.verifyButton.disabled=!1,e.done.resolve(),t){this.refuse(`not verified: ${t}`);return}e.answers.length&&this.showVerdict(e.answers,`at tick ${e.tick}, against the library`)}}async checkItself(){let t=new ie(this.sea);if(!t.possible){this.refuse("this page carries no reference points");return}let{simulation:e}=this.stage;try{let i=await this.alone(()=>t.run(e,this.values.choppiness));this.showVerdict(i,`at ${t.points} points that the file carries`)}catch(i){this.refuse(`not verified: ${i.message}`)}this.changed()}showVerdict(t,e){let i=t.every(c=>c.passed),o=Math.max(...t.map(c=>c.worst)),r=`${i?"Verified":"Not the same"} ${e}: largest relative error ${o.toExponential(1)}`,a=t.flatMap(({tile:c,errors:l,limit:h})=>Object.entries(l).map(([u,f])=>({tile:c,field:u,error:f,limit:h})));this.verdict={passed:i,worst:o,rows:a},this.figures.showVerification({title:r,rows:a}),this.layout.toast(r,i?"note":"refusal"),this.layout.wide&&!this.embedded&&(this.layout.toggle("figures",!0),this.figures.revealVerification())}takeRefusal({message:t,name:e}){let i=e?[e]:Object.keys(this.served),o={};for(let n of i)n in this.served&&(o[n]=this.served[n]);Object.assign(this.values,o),this.controls.show(o,{force:!0}),e&&this.controls.refuse(e,t),this.verifying?this.endVerifying(t):this.refuse(t),this.changed()}refuse(t){this.refusal=t,this.layout.toast(t,"refusal")}showStatus({phase:t,attempts:e,wait:i}){let o={connecting:"connecting",again:"connecting again",open:"connected",waiting:this.connection?.gone?"none: the server is gone":`lost; again in ${i} s`};this.figures.showConnection(t,o[t]),t==="waiting"&&e===1&&this.layout.toast("The server does not answer. The sea goes on; the page tries again."),t==="waiting"&&this.connection?.gone&&!this.serverGone&&this.loseServer(),t==="open"&&(this.serverGone=!1),t==="waiting"&&this.endVerifying("the connection was lost"),t==="open"&&this.wasLost&&this.layout.toast("Connected again"),this.wasLost=t!=="open"&&(this.wasLost||t==="waiting")}loseServer(){this.serverGone=!0,Object.assign(this.values,this.served),this.controls.show(this.served,{force:!0}),this.changed(),this.refuse($i)}takeCanvas(t){this.canvas=t,this.layout.canvas=t;let{signal:e}=this.ending;me(t,this.camera,{onMove:()=>this.moved(),signal:e})}async frame(t){let e=Math.min((t-(this.lastFrame??t))/1e3,.25);this.lastFrame=t;let i=this.clock.update(t);bs(this.camera,this.held,e)&&this.moved();let{stage:o}=this;if(t-(this.lastFigures??-1/0)>1e3*lr&&(this.lastFigures=t,this.showTime()),!o.ready||this.turn)return;let n=o.simulation!==null&&o.simulation.weight!==1;!this.dirty&&this.clock.paused&&!n||!this.dirty&&i===0&&!n&&this.clock.scale===0||(this.dirty=!1,await this.alone(()=>this.picture(i,this.clock.paused?Li:e)),this.frames+=1,this.noteFrame(t/1e3))}async alone(t){for(;this.turn;)await this.turn.catch(()=>{});let e=t();this.turn=e;try{return await e}finally{this.turn=null}}async picture(t,e){let{clock:i,stage:o}=this,{choppiness:n,foam:r}=this.values;o.simulation&&i.follow(o.simulation.document),o.foamIsNew&&await o.growFoam(i,n,this.eye(),r),o.simulation?.advance(e),o.simulation&&i.follow(o.simulation.document),await o.step(i.tick,n),o.ready&&(t!==0&&o.advanceFoam(this.eye(),Math.abs(t),r),this.draw())}eye(){return{east:this.camera.east,north:this.camera.north}}draw(){let{canvas:t,stage:e}=this,i=Math.min(2,globalThis.devicePixelRatio||1)*e.scale,o=Math.max(1,Math.round(t.clientWidth*i)),n=Math.max(1,Math.round(t.clientHeight*i));(t.width!==o||t.height!==n)&&Object.assign(t,{width:o,height:n});let r=this.look();e.render(this.camera,r,o,n);let a=this.fewModel();a&&e.renderFew(a,this.clock.tick,this.camera,r,o,n)}noteFrame(t){this.clock.paused||(this.rate=this.frameRate.note(t),this.levelSince??=t,!(t-this.levelSince>3&&this.frameRate.times.length>2)||this.rate===null||this.rate>=hr)||(this.levelSince=t,this.stage.coarser()&&this.frameRate.clear())}showTime(){let{clock:t,stage:e}=this,i={gpu:"GPU",worker:"JavaScript",playback:"bake"}[e.kind]??"none",o=e.software?", drawn by software":"";this.figures.showTime({rate:this.rate,tick:t.tick,ticks:t.ticks,paused:t.paused,picture:`${i}${o}, ${this.canvas.width} × ${this.canvas.height}`}),this.showSplit()}showSplit(){let t=this.fewModel(),e=this.values.view==="sea"?"":", lit",i=(o,n)=>{let r=this.stage.timer?.milliseconds(o)??null;return r===null?"":`, ${n} ${Number(r.toPrecision(2))} ms`};this.layout.showSplit(t&&[`FFT: ${pe(de(this.sea.document))}${i("waves","transforms")}${i("sea","picture")}`,`${At(t.model)}${e}: ${pe(t.kx.length)}`+i("few","half a picture")])}failed(t){this.stage.gl?.isContextLost()||this.failure===t.message||(this.failure=t.message,this.layout.showBanner(je(t)),console.error(t))}get settled(){let{connection:t,stage:e}=this,i=!t||!!this.bake||this.servedSea===this.sea?.document.id;if(this.bake&&(e.playback?.shownFrame??null)===null)return!1;let o=!!t?.pending?.size||this.busy||!i;return e.ready&&(e.simulation?.weight??1)===1&&!this.dirty&&!this.turn&&!o&&this.sea?.document.quality!=="moving"}get glError(){return this.stage.gl?.getError()??0}dispose(){cancelAnimationFrame(this.handle),this.ending.abort(),this.resizes.disconnect(),this.announcer.dispose(),this.connection?.close?.(),this.stage.dispose(),this.layout.dispose()}};function mr(){let s={};return s.promise=new Promise((t,e)=>Object.assign(s,{resolve:t,reject:e})),s}function Di(s){let t=atob(s);return Uint8Array.from(t,e=>e.charCodeAt(0))}async function Bi(s){let t=new Blob([s]).stream().pipeThrough(new DecompressionStream("deflate"));return new Uint8Array(await new Response(t).arrayBuffer())}function Ui(s,t){let e=s.length/t,i=new Uint8Array(s.length);for(let o=0;o<t;o++)for(let n=0;n<e;n++)i[n*t+o]=s[o*e+n];return i}function Ke(s){return document.getElementById(s)?.textContent.trim()??null}async function gr(){let s=Number(document.getElementById("sea").dataset.planes);return Ui(await Bi(Di(Ke("sea"))),s)}async function vr(){globalThis.fftocean=await Ci({root:document.getElementById("live-page"),table:ns(JSON.parse(Ke("parameters"))),keysOn:globalThis,embedded:{bytes:await gr(),about:JSON.parse(Ke("about")??"{}")}})}vr().catch(s=>{let t=document.createElement("p");t.className="without-scripts",t.setAttribute("role","alert"),t.textContent=`The page cannot start: ${s.message}`,document.body.append(t)});})();
